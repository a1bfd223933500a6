#!/usr/bin/env bash
# Makes Debian packages of Aspic for Debian 12 and 13, each on that Debian, and tries them in an empty one (debootstrap, chroot):
#   scripts/package.sh FOLDER [12] [13]   as root: packages in FOLDER/packages-12 and FOLDER/packages-13; a table at the end
#   scripts/package.sh --here             packages of the Debian that runs, into build/package/packages; nothing is tried
# Below FOLDER each Debian takes 4 GB. Its build is kept there for the next call (scripts/debians.sh keeps its own in the same
# chroot). What is tried: tests/packages/try.sh. Exit code 1 if something fails or the Debians' states differ.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

usage() {
  sed -n '2,6s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
}

# here: packages of this Debian, as lintian wants them.
here() {
  source "$root/scripts/setup.sh"
  aspic_install package
  "$root/scripts/python.sh"
  cd "$root"
  cmake --preset package
  ninja -C build/package --quiet
  rm -rf build/package/packages
  (cd build/package && cpack -G DEB)
  lintian --info --display-info --fail-on error build/package/packages/*.deb | tee build/package/lintian.txt
}

source "$root/scripts/chroots.sh"
place='' wanted=()
for argument in "$@"; do
  case $argument in
    --help | -h) usage; exit ;;
    --here) here; exit ;;
    12 | 13) wanted+=("$argument") ;;
    *) [ -z "$place" ] || { usage >&2; exit 2; }; place=$argument ;;
  esac
done
[ -n "$place" ] || { usage >&2; exit 2; }
[ ${#wanted[@]} -gt 0 ] || wanted=(12 13)
chroots_open "$place"
