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

# here: packages of this Debian, in which lintian finds neither errors nor warnings.
here() {
  source "$root/scripts/setup.sh"
  aspic_install package
  "$root/scripts/python.sh"
  aspic_wasm
  cd "$root"
  cmake --preset package
  ninja -C build/package --quiet
  rm -rf build/package/packages
  (cd build/package && cpack -G DEB)
  lintian --allow-root --info --fail-on error,warning build/package/packages/*.deb
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

rows=() hashes=() status=0
for number in "${wanted[@]}"; do
  build=$folder/debian-$number empty=$folder/empty-$number packages=$folder/packages-$number log=$folder/package-$number
  rm -rf "$packages"
  make_chroot "$build" "$number"
  copy_tree "$build"
  echo "Debian $number: packages" >&2
  made=FAILED tried='not run'
  if inside "$build" env "SOURCE_DATE_EPOCH=$(git -C "$root" log -1 --format=%ct)" /root/aspic/scripts/package.sh --here \
    >"$log-build.log" 2>&1 </dev/null; then
    made=made
    mkdir "$packages"
    cp "$build/root/aspic/build/package/packages/"*.deb "$packages"
    rm -rf "$empty" # an installation that failed half-way is not empty
    make_chroot "$empty" "$number"
    mkdir "$empty/trial"
    cp -r "$packages" "$empty/trial/packages"
    cp "$root/tests/packages/try.sh" "$empty/trial"
    mkdir "$empty/trial/aspic"
    cp -r "$build/root/aspic/"{docs,examples,python,tests,README.md} "$empty/trial/aspic"
    hash=$(inside "$build" /root/aspic/build/package/aspic run cube-bowl --backend reference --steps 200 --json |
      sed -n 's/.*"state_hash": *"\([0-9a-f]*\)".*/\1/p')
    hashes+=("$hash")
    echo "Debian $number: trial in $empty" >&2
    tried=FAILED
    if inside "$empty" /trial/try.sh "$hash" >"$log-try.log" 2>&1 </dev/null; then
      tried=passed
      rm -rf "$empty"
    else
      tail -n 30 "$log-try.log" >&2
    fi
  else
    tail -n 30 "$log-build.log" >&2
  fi
  [ "$made $tried" = "made passed" ] || status=1
  rows+=("$(printf '%-7s %-9s %s' "$number" "$made" "$tried")")
done
printf '%-7s %-9s %s\n' Debian packages trial
printf '%s\n' "${rows[@]}"
find "$folder" -maxdepth 2 -path '*/packages-1[23]/*.deb' -printf '%9s %P\n' | sort -k 2
if [ "$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)" -gt 1 ]; then
  echo "The states of cube-bowl differ: ${hashes[*]}"
  status=1
fi
echo "Complete output: $folder/package-*.log"
exit "$status"
