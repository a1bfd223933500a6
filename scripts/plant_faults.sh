#!/usr/bin/env bash
# Plants the faults of tests/faults/faults.txt one at a time in a copy of the tree and shows that rows of the verification battery and
# tests notice each, and in which tier. Prints a table in Markdown; exit code 1 if one of those named in the list noticed nothing.
# Arguments: --rows or --tests for one of both alone, and words that a fault's name must contain (default: all faults), e.g.
# scripts/plant_faults.sh --tests friction
# scripts/plant_faults.sh --check builds nothing and says which faults no longer change their files.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
list=$root/tests/faults/faults.txt
rows=yes tests=yes check=no words=()
for argument in "$@"; do
  case $argument in
    --check) check=yes ;;
    --rows) tests=no ;;
    --tests) rows=no ;;
    *) words+=("$argument") ;;
  esac
done

outdated() { echo "The change for \"$1\" no longer applies to $2: correct it in tests/faults/faults.txt." >&2; }

if [ "$check" = yes ]; then
  status=0
  while IFS=$'\t' read -r name file change _; do
    [[ $name == \#* || -z $name ]] && continue
    if ! changed=$(sed "$change" "$root/$file") || [ "$changed" = "$(<"$root/$file")" ]; then
      outdated "$name" "$file"
      status=1
    fi
  done <"$list"
  exit "$status"
fi

work=$(mktemp -d "${TMPDIR:-/tmp}/aspic-faults.XXXXXX")
trap 'rm -rf "$work"' EXIT
tree=$work/tree build=$work/build
mkdir "$tree"
# The same sources at another temporary place are the same to the compiler cache.
export CCACHE_BASEDIR=$work CCACHE_NOHASHDIR=1
(cd "$root" && git ls-files -z | xargs -0 cp --parents -t "$tree")
cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DASPIC_BUILD_WINDOW=OFF \
  -DASPIC_WARNINGS_AS_ERRORS=OFF >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }

# make_target TARGET …
make_target() {
  if ! ninja -C "$build" "$@" >"$work/log" 2>&1; then
    tail -n 30 "$work/log" >&2
    return 1
  fi
}

# failing_rows LIST: runs the rows of a comma-separated list; the failed ones on stdout, one a line.
failing_rows() {
  local words=() names name status=0
  make_target aspic aspic-studies || return 2
  IFS=, read -ra names <<<"$1"
  for name in "${names[@]}"; do words+=(--only "$name"); done
  "$build/aspic" verify "${words[@]}" >"$work/table" 2>"$work/messages" || status=$?
  if [ "$status" -gt 1 ]; then
    cat "$work/messages" >&2
    return 2
  fi
  awk '$1 == "FAIL" { print $2 }' "$work/table"
}

# failing_tests PROGRAM FILTER [variable=value …]: runs tests of a program; the failed ones on stdout, one a line.
failing_tests() {
  local program=$1 filter=$2 status=0
  shift 2
  make_target "$program" || return 2
  local path
  path=$(find "$build/tests" -type f -name "$program" -perm -u+x)
  env "$@" "$path" --gtest_filter="$filter" >"$work/tests" 2>&1 || status=$?
  if [ "$status" -ne 0 ] && ! grep -q '^\[  FAILED  \]' "$work/tests"; then
    echo "$program ended with $status"
  fi
  sed -n 's/^\[  FAILED  \] \([^ ,]*\).* (.* ms)$/\1/p' "$work/tests"
}

# cell: up to three lines of stdin as a cell of the table.
cell() {
  local lines more
  mapfile -t lines
  more=$((${#lines[@]} - 3))
  printf '%s\n' "${lines[@]:0:3}" | sed 's/.*/`&`/' | paste -sd, | sed 's/,/, /g' | tr -d '\n'
  [ "$more" -le 0 ] || printf ' and %d more' "$more"
}

# detect DETECTOR: "rows LIST", or "TIER PROGRAM FILTER [variable=value …]".
detect() {
  local words
  read -ra words <<<"$1"
  if [ "${words[0]}" = rows ]; then failing_rows "${words[1]}"; else failing_tests "${words[@]:1}"; fi
}

unnoticed=0
declare -A sound=()
echo "| fault | file | \`aspic verify\` | core tier | full tier |"
echo "|---|---|---|---|---|"
while IFS=$'\t' read -r name file change checks detectors; do
  [[ $name == \#* || -z $name ]] && continue
  for word in "${words[@]}"; do [[ $name == *"$word"* ]] || continue 2; done
  wanted=()
  if [ "$rows" = yes ] && [ "$checks" != - ]; then wanted+=("rows $checks"); fi
  if [ "$tests" = yes ]; then
    IFS=';' read -ra tiers <<<"$detectors"
    for tier in "${tiers[@]}"; do wanted+=("$(xargs -0 <<<"$tier")"); done
  fi
  for detector in "${wanted[@]}"; do
    [ -z "${sound[$detector]:-}" ] || continue
    before=$(detect "$detector") || exit 2
    if [ -n "$before" ]; then
      echo "Without any fault these fail already: $before" >&2
      exit 2
    fi
    sound[$detector]=yes
  done
  echo "Planting: $name …" >&2
  cp -p "$tree/$file" "$work/original"
  sed -i "$change" "$tree/$file"
  if cmp -s "$tree/$file" "$work/original"; then
    outdated "$name" "$file"
    exit 2
  fi
  declare -A noticed=([rows]="" [core]="" [full]="")
  for detector in "${wanted[@]}"; do
    failed=$(detect "$detector") || exit 2
    column=${detector%% *}
    if [ -z "$failed" ]; then
      unnoticed=1
      found="**nothing** (${detector#* })"
    else
      found=$(cell <<<"$failed")
    fi
    noticed[$column]+="${noticed[$column]:+, }$found"
  done
  cp "$work/original" "$tree/$file"
  echo "| $name | \`$file\` | ${noticed[rows]:-–} | ${noticed[core]:-–} | ${noticed[full]:-–} |"
done <"$list"
exit "$unnoticed"
