#!/usr/bin/env bash
# Builds the program and attacks it: scripts/attack.sh [--thorough] [SUITE …], suites by name (scripts/attack.sh --list) or all.
# --thorough tries every allocation, file operation and pass instead of samples; some suites take ten minutes then. Exit code 1 on a finding.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

aspic_install all
aspic_build ON programs aspic_fault_shim
thorough=() suites=()
for word in "$@"; do
  case $word in
    --thorough) thorough=(--thorough) ;;
    --list) ctest --test-dir "$aspic_build_dir" -L attack -N | sed -n 's/.*Attack\.\([a-z_]*\)$/\1/p'; exit ;;
    *) suites+=("$word") ;;
  esac
done
declare -A file_of
while read -r file suite; do file_of[$suite]=$file; done < <(
  sed -n 's/^ *aspic_attack(\([a-z_]*\.py\) \(.*\))$/\1 \2/p' tests/attack/CMakeLists.txt |
    while read -r file list; do for suite in $list; do echo "$file $suite"; done; done)
[ "${#suites[@]}" -gt 0 ] || mapfile -t suites < <(printf '%s\n' "${!file_of[@]}" | sort)
status=0
for suite in "${suites[@]}"; do
  [ -n "${file_of[$suite]:-}" ] || { echo "No attack is called '$suite': see scripts/attack.sh --list." >&2; exit 2; }
  echo "$suite:"
  PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "tests/attack/${file_of[$suite]}" "$aspic_build_dir/aspic" \
    "$aspic_build_dir/tests/attack/libaspic_fault_shim.so" "$suite" "${thorough[@]}" || status=1
done
exit "$status"
