# complete.zsh DIRECTORY HOME PROGRAMS: what a zsh at a terminal makes of words whose ends are left to the tabulator.
zmodload zsh/zpty
zpty shell "HOME=$2 ZDOTDIR=$2 TERM=dumb zsh -f -i"
zpty -w shell "PATH=$3:\$PATH; PS1=; PS2=; unsetopt zle_bracketed_paste 2>/dev/null; fpath=($1 \$fpath); autoload -Uz compinit; compinit -u -d $2/dump"
zpty -w shell "show() { print -r -- \"<\$BUFFER>\"; BUFFER=; zle accept-line }; zle -N show; bindkey '^X' show; print re\"\"ady"
zpty -r -m shell ready '*ready*'
for words in 'aspic run --backend=r' 'aspic run --checkpoint-e' 'aspic scene im' 'aspic-view --layout=le' 'aspic run cube-bo' \
  'aspic run --set simulation.times' 'aspic bench --integrator v'; do
  zpty -w -n shell "$words"$'\t\x18'
  zpty -r -m shell seen '*<*>*'
  seen=${${seen##*<}%%>*}
  print -r -- "${seen%% }"
done
zpty -d shell
