# Completion of aspic and aspic-view for bash.
_aspic() {
  local current=${COMP_WORDS[COMP_CWORD]} word
  [[ $current == = ]] && current=
  COMPREPLY=()
  while IFS=$'\t' read -r word _; do
    case $word in
      :directory) _aspic_names -d "$current" '*' ;;
      :file) _aspic_names -f "$current" '*' ;;
      :toml) _aspic_names -f "$current" '*.toml' ;;
      *)
        COMPREPLY+=("$word")
        [[ $word == *= ]] && compopt -o nospace
        ;;
    esac
  done < <("${COMP_WORDS[0]/%aspic-view/aspic}" --complete "${COMP_WORDS[@]:0:COMP_CWORD+1}" 2>/dev/null)
}
_aspic_names() {
  local name
  compopt -o filenames
  while IFS= read -r name; do
    [[ $name == $3 || -d $name ]] && COMPREPLY+=("$name")
  done < <(compgen "$1" -- "$2")
}
complete -F _aspic aspic aspic-view
