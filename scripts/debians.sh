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

declare -A codename=([12]=bookworm [13]=trixie)
folder='' wanted=()
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) usage; exit ;;
    --) shift; break ;;
    12 | 13) wanted+=("$1") ;;
    *) [ -z "$folder" ] || { usage >&2; exit 2; }; folder=$1 ;;
  esac
  shift
done
[ -n "$folder" ] || { usage >&2; exit 2; }
[ ${#wanted[@]} -gt 0 ] || wanted=(12 13)
[ "$(id -u)" -eq 0 ] || { echo "debootstrap and chroot need root: run this script with sudo." >&2; exit 1; }
command -v debootstrap >/dev/null || { echo "debootstrap is missing: apt-get install debootstrap" >&2; exit 1; }
mirror=${ASPIC_DEBIAN_MIRROR:-$(apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
  awk '$1 == "Debian" { print $2; exit }')}
[ -n "$mirror" ] || { echo "apt uses no Debian mirror here: set ASPIC_DEBIAN_MIRROR to the address of one." >&2; exit 1; }
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)

# inside DEBIAN COMMAND …: in the chroot, without the caller's environment. Mounts and processes end with the command.
inside() {
  local debian=$1
  shift
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount -t sysfs sys "$0/sys" && mount --rbind /dev "$0/dev" &&
      mount -t tmpfs -o mode=1777 shm "$0/dev/shm" || exit
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "$@"' "$debian" "$@"
}

# copy_tree DEBIAN: the tracked files, and the build as it was left.
copy_tree() {
  local tree=$1/root/aspic
  mkdir -p "$tree"
  find "$tree" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  (cd "$root" && git ls-files -z | while IFS= read -r -d '' file; do [ -e "$file" ] && printf '%s\0' "$file"; done |
    tar --create --null --files-from=- --owner=0 --group=0) | tar --extract --directory "$tree"
}

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
  if [ ! -e "$debian/etc/debian_version" ]; then
    echo "Debian $number: debootstrap into $debian" >&2
    debootstrap --variant=minbase "${codename[$number]}" "$debian" "$mirror" >"$folder/debian-$number-bootstrap.log" 2>&1 ||
      { tail -n 30 "$folder/debian-$number-bootstrap.log" >&2; exit 1; }
  fi
  cp -L /etc/resolv.conf "$debian/etc/resolv.conf"
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
