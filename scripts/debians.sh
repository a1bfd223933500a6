#!/usr/bin/env bash
# Tries scripts/run.sh and scripts/test.sh on Debian 12 and 13, each in a folder of its own (debootstrap, chroot). As root:
#   scripts/debians.sh FOLDER [12] [13] [-- ARGUMENT …]
# Below FOLDER each Debian takes 5 GB. It is kept there with its build for the next call; remove it for a fresh one. The tracked
# files are copied in as they lie here. Arguments after -- go to scripts/test.sh. Prints a table; exit code 1 if a command fails
# or the Debians' states of cube-plane differ. Packages come from ASPIC_DEBIAN_MIRROR, by default from the mirror that apt uses here.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

usage() {
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
}

source "$root/scripts/chroots.sh"
place='' wanted=()
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) usage; exit ;;
    --) shift; break ;;
    12 | 13) wanted+=("$1") ;;
    *) [ -z "$place" ] || { usage >&2; exit 2; }; place=$1 ;;
  esac
  shift
done
[ -n "$place" ] || { usage >&2; exit 2; }
[ ${#wanted[@]} -gt 0 ] || wanted=(12 13)
chroots_open "$place"

# version DEBIAN PACKAGE: upstream's part.
version() {
  inside "$1" dpkg-query -W -f '${Version}' "$2" 2>/dev/null | sed 's/^[0-9]*://; s/[-+~].*//' || true
}

# try DEBIAN LOG COMMAND …: "passed" or "FAILED" and the seconds, as two words.
try() {
  local debian=$1 log=$2 started=$SECONDS verdict=passed
  shift 2
  inside "$debian" sh -c 'cd /root/aspic && exec "$@"' sh "$@" >"$log" 2>&1 </dev/null || verdict=FAILED
  [ "$verdict" = passed ] || tail -n 30 "$log" >&2
  echo "$verdict $((SECONDS - started))"
}

rows=() hashes=() status=0
for number in "${wanted[@]}"; do
  debian=$folder/debian-$number
  make_chroot "$debian" "$number"
  copy_tree "$debian"
  echo "Debian $number: scripts/run.sh" >&2
  read -r run run_seconds < <(try "$debian" "$folder/debian-$number-run.log" scripts/run.sh)
  test='not run' test_seconds=0
  if [ "$run" = passed ]; then
    hashes+=("$(awk '/^state hash/ { print $3 }' "$folder/debian-$number-run.log")")
    echo "Debian $number: scripts/test.sh $*" >&2
    read -r test test_seconds < <(try "$debian" "$folder/debian-$number-test.log" scripts/test.sh "$@")
  fi
  [ "$run $test" = "passed passed" ] || status=1
  rows+=("$(printf '%-7s %-8s %-8s %-8s %-8s %6s s  %-8s %6s s' "$number" "$(version "$debian" cpp)" "$(version "$debian" cmake)" \
    "$(version "$debian" libgl1-mesa-dri)" "$run" "$run_seconds" "$test" "$test_seconds")")
done
printf '%-7s %-8s %-8s %-8s %-17s  %s\n' Debian g++ CMake Mesa run.sh test.sh
printf '%s\n' "${rows[@]}"
if [ "$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)" -gt 1 ]; then
  echo "The states of cube-plane differ: ${hashes[*]}"
  status=1
fi
echo "Complete output: $folder/debian-*.log"
exit "$status"
