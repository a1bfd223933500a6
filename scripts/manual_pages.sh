#!/usr/bin/env bash
# Manual pages of aspic and of each of its commands, by help2man from --help; exit codes and environment from docs/commands.md.
# Usage: scripts/manual_pages.sh PROGRAM COMMANDS.md DIRECTORY
set -euo pipefail
program=$1 markdown=$2 directory=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rm -rf "$directory"
mkdir -p "$directory"
version=$("$program" --version)

# section TITLE: its table of two columns as roff.
section() {
  awk -F ' *[|] *' -v title="## $1" '/^## / { on = $0 == title } on && NF == 4 && $2 !~ /^-|^variable$|^code$|^file$/ {
    for (n = 2; n < 4; ++n) {
      while (match($n, /\[[^]]*\]\([^)]*\)/)) {
        link = substr($n, RSTART + 1, RLENGTH - 1)
        sub(/\].*/, "", link)
        $n = substr($n, 1, RSTART - 1) link substr($n, RSTART + RLENGTH)
      }
      gsub(/`|\*\*/, "", $n); gsub(/\001/, "|", $n); gsub(/-/, "\\-", $n)
    }
    printf ".TP\n\\fB%s\\fR\n%s\n", $2, $3 }' < <(sed 's/\\|/\x01/g' "$markdown")
}

# page WORD …: of the command `aspic WORD …`; those below `scene` are in its page.
page() {
  local name=aspic${1:+-$1} summary below
  "$program" "$@" --help >"$work/help"
  summary=$(head -1 "$work/help")
  # Examples keep their lines: help2man would fill them.
  sed '/^Examples*:/,$d' "$work/help" >"$work/text"
  {
    printf '[examples]\n.nf\n'
    sed -n '/^Examples*:/,$p' "$work/help" | sed '1d; s/^  //; s/\\/\\e/g; s/-/\\-/g; s/^\./\\\&./'
    printf '.fi\n[exit status]\n'
    section 'Exit codes'
    printf '[environment]\n'
    section Environment
    printf '[files]\n'
    section Files
    printf '[see also]\n'
    for below in $commands; do
      [ "aspic-$below" = "$name" ] || printf '.BR aspic\\-%s (1),\n' "$below"
    done
    printf '.BR %s (1)\n' "$([ "$name" = aspic ] && echo aspic\\-view || echo aspic)"
  } >"$work/include"
  if [ "${1-}" = scene ]; then
    for below in $("$program" scene --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
      "$program" scene "$below" --help | sed "1s/.*/\nCommand aspic scene $below:/; /^Usage:/d; /^Examples*:/,\$d" >>"$work/text"
    done
  fi
  help2man --no-info --help-option="$work/text" --name="${summary,}" --version-string="$version" --source="$version" \
    --include="$work/include" --output="$directory/$name.1" cat
  sed -i "s/^\.TH ASPIC /.TH ${name^^} /; s/^aspic \\\\- /${name/-/\\\\-} \\\\- /; s/^Command \(aspic scene [a-z]*\):\$/.SS \1/" "$directory/$name.1"
}

commands=$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
page
for command in $commands; do page "$command"; done
