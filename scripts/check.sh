#!/usr/bin/env bash
# Holds the tree to its rules: scripts/check.sh [STEP …], steps by name or all; scripts/check.sh --help lists them.
# Installs what is missing. Exit code 1 if a step finds something; its complete output is in build/check/STEP.log.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

steps=(format lints alone clang tidy odr asan tsan)
declare -A meaning=(
  [format]="every C++ file is as clang-format leaves it (.clang-format)"
  [lints]="tests of the text: exact kernels, pointers between pages, arrows between rooms, sizes of files, the scene reference"
  [alone]="what changed in the last day's commits compiles by itself, with clang: no precompiled header or neighbor hides a missing include"
  [clang]="everything compiles with clang without a warning"
  [tidy]="clang-tidy finds nothing (.clang-tidy)"
  [odr]="no name has two definitions in a program (g++ -flto -Wodr)"
  [asan]="the tests under address and undefined-behavior sanitizers, on one driver"
  [tsan]="the tests with threads, child processes and signals under the thread sanitizer"
)

if [[ " $* " == *" --help "* || " $* " == *" -h "* ]]; then
  echo "scripts/check.sh [STEP …]   runs the steps named, or all in this order:"
  for step in "${steps[@]}"; do printf '  %-8s %s\n' "$step" "${meaning[$step]}"; done
  echo "Builds are kept in build/; the first run takes three hours on two cores, later ones somewhat more than one."
  exit
fi
chosen=("${@:-${steps[@]}}")
for step in "${chosen[@]}"; do
  [ -n "${meaning[$step]:-}" ] || { echo "No step is called '$step'; there are: ${steps[*]}." >&2; exit 2; }
done

aspic_install all
cd "$aspic_root"
logs=$aspic_root/build/check
mkdir -p "$logs"

# files PATTERN …: the tracked files that match and exist.
files() { git ls-files -- "$@" | while read -r file; do if [ -f "$file" ]; then echo "$file"; fi; done; }

# build PRESET [TARGET …]: builds, configured as CMakePresets.json says.
build() {
  local preset=$1
  shift
  [ "build/$preset/build.ninja" -nt CMakePresets.json ] || cmake --preset "$preset" || return 1
  cmake --build --preset "$preset" -- --quiet "$@"
}

# test_in PRESET [ARGUMENT …]: one test after the other for each processor.
test_in() {
  local preset=$1
  shift
  ctest --preset "$preset" --no-tests=error -j "$(nproc)" "$@"
}

step_format() { files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror; }

step_lints() {
  aspic_build ON repository_tests gpu_tests scene_tests || return 1
  ctest --test-dir "$aspic_build_dir" --output-on-failure --no-tests=error -R '^(TextLint|PageList|FileSizes|Rooms|PreciseLint|PortableLint|Reference)\.'
}

# C++ files of the last day's commits, the newest first, and those that are not committed yet.
changed_files() {
  local since changed
  since=$(($(git show -s --format=%ct HEAD) - 86400)) || return 1
  changed=$(git diff --name-only HEAD && git ls-files -o --exclude-standard &&
    git -c log.showRoot=false log --since="$since" --name-only --format=) || return 1
  awk '/\.(cpp|h)$/ && !seen[$0]++' <<<"$changed" | while read -r file; do if [ -f "$file" ]; then echo "$file"; fi; done
}

# alone_header FILE: includes a header in an otherwise empty file, with the flags of a file of its room.
alone_header() {
  local neighbor command
  neighbor=$(files "$(cut -d / -f 1-2 <<<"$1")/*.cpp" | head -n 1)
  [ -n "$neighbor" ] || neighbor=examples/minimal.cpp # public headers
  command=$(flock build/alone/lock ninja -C build/alone -t commands -s "$aspic_root/$neighbor^" | sed 's/ -MD .*//')
  (cd build/alone && echo "#include \"${1#*/}\"" | eval "$command -fsyntax-only -x c++ -") || { echo "^ $1" && return 1; }
}

# alone_part ITEM …: compiles a few files, which Ninja calls FILE^, and headers.
alone_part() {
  local item files=() headers=() failed=0
  for item in "$@"; do
    if [[ $item == *^ ]]; then files+=("$item"); else headers+=("$item"); fi
  done
  if [ ${#files[@]} -gt 0 ]; then ninja -C build/alone -k 0 --quiet "${files[@]}" || failed=1; fi
  if [ ${#headers[@]} -gt 0 ]; then
    printf '%s\0' "${headers[@]}" | xargs -0 -n 1 -P "$(nproc)" "$BASH" -c 'alone_header "$1"' alone || failed=1
  fi
  return "$failed"
}

# A header is compiled as the .cpp of its name or, without one, by itself. As many at once as there are processors, until ASPIC_ALONE_SECONDS
# are over if they are set.
step_alone() {
  local files file items=() part at=0 failed=0 started
  files=$(changed_files) || return 1
  cmake --preset alone || return 1
  if [ "$(ninja -C build/alone -t commands "$aspic_root/src/main.cpp^" | grep -c -e ' -c ')" -gt 1 ]; then
    echo "error: src/main.cpp waits for other objects; a custom command depends on a library (ninja -C build/alone -t commands $aspic_root/src/main.cpp^)"
    return 1
  fi
  while read -r file; do
    if [[ $file == *.h && -f ${file%.h}.cpp ]]; then file=${file%.h}.cpp; fi
    if grep -qF "\"file\": \"$aspic_root/$file\"" build/alone/compile_commands.json; then
      [[ " ${items[*]} " == *" $aspic_root/$file^ "* ]] || items+=("$aspic_root/$file^")
    elif [[ $file == src/*.h || $file == include/*.h ]]; then
      items+=("$file")
    fi # others, of fuzzers for one, have no target in this build
  done <<<"$files"
  export aspic_root
  export -f alone_header files
  part=$(nproc) # few, since one may take half a minute
  started=$SECONDS
  while [ "$at" -lt "${#items[@]}" ]; do
    if [ $((SECONDS - started)) -ge "${ASPIC_ALONE_SECONDS:-86400}" ]; then
      echo "alone: $at files compiled, $((${#items[@]} - at)) older ones left for want of time" | tee /dev/fd/3
      break
    fi
    alone_part "${items[@]:at:part}" || failed=1
    at=$((at + part))
  done
  return "$failed"
}

# tidy_one FILE: what was found clean is checked again once it changes. build/check/tidy keeps check sums of the file and of the
# project's headers that it includes, under a name made from its command and the checks.
# Ninja may tidy up its own log when it opens it, so one asks at a time.
tidy_one() {
  local commands object stamp
  commands=$(grep -F -B 1 "\"file\": \"$aspic_root/$1\"" build/asan/compile_commands.json) || return 0 # not compiled here
  object=$(sed -n 's/.* -o \([^ ]*\) .*/\1/p' <<<"$commands" | head -n 1)
  stamp=$logs/tidy/$({ clang-tidy --version; cat .clang-tidy "${1%/*}/.clang-tidy" 2>/dev/null; echo "$commands"; } | sha256sum | cut -c 1-32)
  if [ -f "$stamp" ] && sha256sum --check --status "$stamp"; then return 0; fi
  flock "$logs/tidy/lock" ninja -C build/asan -t deps "$object" | sed -n 's/^    //p' | grep -v '^/usr/' | (cd build/asan && xargs realpath) |
    xargs sha256sum >"$stamp.new" || return 1
  clang-tidy -p build/asan --quiet "$1" && mv "$stamp.new" "$stamp"
}

# After a build, which generates headers and records in Ninja what each file includes.
step_tidy() {
  step_clang || return 1
  mkdir -p "$logs/tidy"
  export -f tidy_one
  export aspic_root logs
  files 'src/*.cpp' 'tests/*.cpp' 'bench/*.cpp' 'examples/*.cpp' | xargs -P "$(nproc)" -I '{}' bash -c 'tidy_one "$1"' tidy_one '{}'
}

step_clang() { build asan; }
step_odr() { build odr; }
step_asan() { build asan && test_in asan; }
step_tsan() { build tsan && test_in tsan; }

status=0
results=()
for step in "${chosen[@]}"; do
  echo "== $step: ${meaning[$step]}" >&2
  started=$SECONDS
  if "step_$step" 3>&2 >"$logs/$step.log" 2>&1; then
    verdict=passed
  else
    verdict=FAILED
    status=1
    grep -E "error|warning|WARNING|FAILED|Failure|\*\*\*" "$logs/$step.log" | head -n 40 >&2 || tail -n 40 "$logs/$step.log" >&2
  fi
  results+=("$(printf '%-8s %-7s %5d s  %s' "$step" "$verdict" $((SECONDS - started)) "build/check/$step.log")")
done
printf '%s\n' "${results[@]}"
exit "$status"
