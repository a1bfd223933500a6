#!/usr/bin/env bash
# Plants the faults of tests/faults/faults.txt one at a time in a copy of the tree and shows that the verification
# battery notices each. Prints a table in Markdown; exit code 1 if a fault went unnoticed.
# Arguments: words that a fault's name must contain (default: all faults), e.g. scripts/plant_faults.sh friction
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
list=$root/tests/faults/faults.txt
work=$(mktemp -d "${TMPDIR:-/tmp}/aspic-faults.XXXXXX")
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build
mkdir "$tree"
# The same sources at another temporary place are the same to the compiler cache.
export CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1
(cd "$root" && git ls-files -z | xargs -0 cp --parents -t "$tree")

build_program() {
  if ! ninja -C "$build" aspic >"$work/log" 2>&1; then
    tail -n 30 "$work/log" >&2
    return 1
  fi
}

echo "Building the tree as it is …" >&2
cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DASPIC_BUILD_TESTS=OFF -DASPIC_WARNINGS_AS_ERRORS=OFF \
  >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
build_program

# rows LIST: runs the rows of a comma-separated list; the failed ones on stdout, one a line.
rows() {
  local words=() name
  IFS=, read -ra names <<<"$1"
  for name in "${names[@]}"; do words+=(--only "$name"); done
  local status=0
  "$build/aspic" verify "${words[@]}" >"$work/table" 2>"$work/messages" || status=$?
  if [ "$status" -gt 1 ]; then
    cat "$work/messages" >&2
    return 2
  fi
  awk '$1 == "FAIL" { print $2 }' "$work/table"
}

unnoticed=0
echo "| fault | file | detected by |"
echo "|---|---|---|"
while IFS=$'\t' read -r name file change checks; do
  [[ $name == \#* || -z $name ]] && continue
  for word in "$@"; do [[ $name == *"$word"* ]] || continue 2; done
  echo "Planting: $name …" >&2
  before=$(rows "$checks") || exit 2
  if [ -n "$before" ]; then
    echo "Without any fault these rows fail already: $before" >&2
    exit 2
  fi
  cp -p "$tree/$file" "$work/original"
  sed -i "$change" "$tree/$file"
  if cmp -s "$tree/$file" "$work/original"; then
    echo "The change for \"$name\" no longer applies to $file: correct it in tests/faults/faults.txt." >&2
    exit 2
  fi
  build_program
  failed=$(rows "$checks") || exit 2
  cp "$work/original" "$tree/$file"
  if [ -z "$failed" ]; then
    unnoticed=1
    noticed="**nothing**"
  else
    noticed=$(head -n 3 <<<"$failed" | sed 's/.*/`&`/' | paste -sd, | sed 's/,/, /g')
    more=$(($(wc -l <<<"$failed") - 3))
    [ "$more" -gt 0 ] && noticed="$noticed and $more more"
  fi
  echo "| $name | \`$file\` | $noticed |"
  build_program
done <"$list"
exit "$unnoticed"
