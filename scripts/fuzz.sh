#!/usr/bin/env bash
# Builds the fuzzers and runs each for SECONDS (default 10): scripts/fuzz.sh [SECONDS] [TARGET …], targets by name or all.
# As many run at once as there are processors. Exit code 1 on a finding, whose input is left in build/fuzz/findings.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

seconds=${1:-10}
[ $# -gt 0 ] && shift
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "SECONDS must be a whole number above 0, not '$seconds'." >&2; exit 2; }
all=(scene set view checkpoint inputs configuration state-csv kept-state npy shader mesh-obj mesh-stl mesh-ply)
chosen=("${@:-${all[@]}}")
for target in "${chosen[@]}"; do
  [[ " ${all[*]} " == *" $target "* ]] || { echo "No fuzzer is called '$target'; there are: ${all[*]}." >&2; exit 2; }
done

aspic_install all
cd "$aspic_root"
build=$aspic_root/build/fuzz
started=$SECONDS
if [ ! -f "$build/build.ninja" ]; then cmake --preset fuzz >&2; fi
if ! ninja -C "$build" --quiet fuzzers >"$build/build.log" 2>&1; then
  cat "$build/build.log" >&2
  echo "The fuzzers could not be built; the compiler's messages are above." >&2
  exit 1
fi
echo "Built the fuzzers in $((SECONDS - started)) s." >&2

rm -rf "$build/seeds"
mkdir -p "$build/seeds" "$build/findings"
memory=/dev/shm
[ -w "$memory" ] || memory=${TMPDIR:-/tmp}
TMPDIR=$(mktemp -d "$memory/aspic-fuzz.XXXXXX") # the shader target writes files for each input
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_leaks=1 TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
"$build/tests/fuzz/fuzz_seeds" "$build/seeds"

# fuzz TARGET: one fuzzer's run, its output in a log, its finding's name begun with the kind (crash-, timeout-, oom-, leak-).
fuzz() {
  local target=$1 corpus=$build/corpus/$1 kept=$aspic_root/tests/fuzz/regressions/$1
  mkdir -p "$corpus" "$build/findings/$target"
  local inputs=("$corpus" "$build/seeds/$target")
  [ -d "$kept" ] && inputs+=("$kept")
  "$build/tests/fuzz/fuzz-$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=512 \
    -max_len=16384 -dict="$build/seeds/$target.dict" -artifact_prefix="$build/findings/$target/" -print_final_stats=1 \
    "${inputs[@]}" >"$build/$target.log" 2>&1
}

started=$SECONDS
status=0
declare -A running=()
# collect: waits for one fuzzer and says how it went.
collect() {
  local ended=0 finished
  wait -n -p finished || ended=$?
  local target=${running[$finished]}
  unset "running[$finished]"
  local runs
  runs=$(awk '$1 == "stat::number_of_executed_units:" { print $2 }' "$build/$target.log")
  if [ "$ended" -eq 0 ]; then
    echo "$target: ${runs:-0} inputs, nothing found"
    return
  fi
  status=1
  echo "$target: A FINDING after ${runs:-an unknown number of} inputs"
  grep -aE -A 25 "ERROR: |runtime error|terminate called|what\(\):" "$build/$target.log" | head -n 60 || tail -n 20 "$build/$target.log"
  local input
  input=$(grep -aoE "Test unit written to .*" "$build/$target.log" | head -n 1 | sed 's/Test unit written to //') || true
  if [ -n "$input" ]; then
    echo "  once more:  $build/tests/fuzz/fuzz-$target $input"
    echo "  to keep it: mkdir -p tests/fuzz/regressions/$target && cp $input tests/fuzz/regressions/$target/WHAT-IT-IS"
  fi
}
trap 'kill "${!running[@]}" 2>/dev/null || true; rm -rf "$TMPDIR"' EXIT
for target in "${chosen[@]}"; do
  while [ "${#running[@]}" -ge "$(nproc)" ]; do collect; done
  fuzz "$target" &
  running[$!]=$target
done
while [ "${#running[@]}" -gt 0 ]; do collect; done
echo "${#chosen[@]} fuzzers, $seconds s each, in $((SECONDS - started)) s."
exit "$status"
