#!/usr/bin/env bash
# try.sh HASH: tries the packages of an empty Debian, in its chroot (scripts/package.sh). This folder has them in packages/, the sources in
# aspic/. HASH is what the program hashes in the build: that of cube-bowl after 200 steps. Each step says what it found; the first that fails ends it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
wanted=$1
export DEBIAN_FRONTEND=noninteractive
cd "$here"
log=$here/log

quietly() { "$@" >"$log" 2>&1 || { tail -n 30 "$log"; fail "$* failed"; }; }
fail() { echo "FAILED: $*"; exit 1; }
# expect NAME HASH
expect() {
  [ "$2" = "$wanted" ] || fail "$1 ends with the state $2 in place of $wanted"
  echo "$1: $2"
}
get() { quietly apt-get install -q -y --no-install-recommends "$@"; }
# Everything of a package, wherever it is; not what apt keeps of packages that were there.
traces() { find / -xdev -path "$here" -prune -o -path /proc -prune -o -path /sys -prune -o -path /var/log -prune -o -path /var/cache -prune -o -iname '*aspic*' -print; }

[ -z "$(traces)" ] || fail "this Debian has Aspic already: $(traces)"
quietly apt-get update -q

has_egl() { [[ $(ldconfig -p) == *libEGL.so* ]]; }
python_state() { python3 -c "import aspic; sim = aspic.Simulation('cube-bowl', '$1'); sim.step(200); print(sim.hash)"; }

echo "--- python3-aspic"
get ./packages/libaspic0*.deb ./packages/python3-aspic_*.deb
if has_egl; then fail "EGL came with the library: it is recommended, not needed"; fi
expect "python3 on reference" "$(python_state reference)"
expect "python3 on cpu" "$(python_state cpu)"
if python_state gpu >"$log" 2>&1; then fail "python3 found a device"; fi
grep -q '^aspic.*DeviceError: ' "$log" || fail "without EGL, python3 says $(cat "$log")"
echo "gpu, without EGL: $(tail -n 1 "$log")"

echo "--- libaspic-dev"
get ./packages/libaspic-dev_*.deb g++ cmake make
if has_egl; then fail "EGL came with the headers: it is recommended, not needed"; fi
mkdir -p lab
cp aspic/examples/minimal.cpp lab
lab_state() { "$1" cube-bowl 200 "$2" | awk '/^state hash/ { print $3 }'; }
for kind in shared static; do
  cat >lab/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.25)
project(lab LANGUAGES CXX)
find_package(aspic 0.3 REQUIRED COMPONENTS $kind)
add_executable(lab minimal.cpp)
target_link_libraries(lab PRIVATE aspic::aspic)
END
  quietly cmake -S lab -B "lab/$kind" -DCMAKE_BUILD_TYPE=Release
  quietly cmake --build "lab/$kind"
  for backend in cpu reference; do
    expect "find_package(aspic), $kind, on $backend" "$(lab_state "lab/$kind/lab" $backend)"
  done
  code=0
  "lab/$kind/lab" cube-bowl 200 gpu >"$log" 2>&1 || code=$?
  [ "$code" = 4 ] || fail "without EGL, the program ended with $code in place of 4 on gpu: $(cat "$log")"
  grep -q libegl1 "$log" || fail "without EGL, the program says on gpu $(cat "$log")"
  echo "find_package(aspic), $kind, on gpu, without EGL: $(head -n 1 "$log")"
done
quietly g++ -std=c++20 lab/minimal.cpp $(pkg-config --cflags --libs aspic) -o lab/by-pkg-config
expect "pkg-config" "$(lab_state lab/by-pkg-config cpu)"

echo "--- aspic"
get ./packages/aspic_*.deb
aspic --version
state() { aspic run cube-bowl --steps 200 --json --backend "$@" | sed -n 's/.*"state_hash": *"\([0-9a-f]*\)".*/\1/p'; }
expect "aspic run on reference" "$(state reference)"
expect "aspic run on cpu" "$(state cpu)"
code=0
aspic run cube-bowl --steps 5 --html-live live.html >"$log" 2>&1 || code=$?
case $code in
  0) echo "a page that simulates: $(stat -c %s live.html) bytes" ;;
  6) grep -q scripts/wasm.sh "$log" && echo "made without pages that simulate: $(tail -n 1 "$log")" || fail "--html-live says $(cat "$log")" ;;
  *) fail "--html-live ended with $code: $(cat "$log")" ;;
esac
if [[ $(dpkg-query -W -f '${Depends}' aspic) == *egl* ]]; then fail "aspic depends on EGL: it is recommended, not needed"; fi
# On Debian 13 GLFW brings it, with Mesa.
if ! has_egl; then
  code=0
  aspic run cube-bowl --steps 200 --backend gpu >"$log" 2>&1 || code=$?
  [ "$code" = 4 ] || fail "without EGL, --backend gpu ended with $code in place of 4: $(cat "$log")"
  echo "gpu, without EGL: $(head -n 1 "$log")"
fi
aspic-view --help >"$log"
grep -q 'Usage: aspic view' "$log" || fail "aspic-view --help says $(cat "$log")"
code=0
aspic view >"$log" 2>&1 || code=$?
[ "$code" = 4 ] || fail "without a display, aspic view ended with $code in place of 4: $(cat "$log")"
echo "aspic view, without a display: $(head -n 1 "$log")"
bash -c 'source /usr/share/bash-completion/completions/aspic && complete -p aspic-view >/dev/null' || fail "bash does not read the completion"
get man-db desktop-file-utils
for page in aspic aspic-run aspic-view aspic-scene; do
  MANWIDTH=80 LC_ALL=C.UTF-8 man "$page" >page.txt 2>"$log"
  grep -q 'EXIT STATUS' page.txt || fail "man $page: $(cat "$log")"
  [ ! -s "$log" ] || fail "man $page says $(cat "$log")"
done
quietly desktop-file-validate /usr/share/applications/aspic.desktop
[ ! -s "$log" ] || fail "desktop-file-validate says $(cat "$log")"
[ -s /usr/share/icons/hicolor/scalable/apps/aspic.svg ] || fail "there is no icon"
[ -s /usr/share/doc/aspic/scene-reference.md ] || fail "there are no documents"

echo "--- with EGL and Mesa"
get libegl1 libgl1-mesa-dri
expect "aspic run on gpu" "$(state gpu)"
for kind in shared static; do expect "find_package(aspic), $kind, on gpu" "$(lab_state "lab/$kind/lab" gpu)"; done

echo "--- python3-aspic on gpu"
expect "python3 on gpu" "$(python_state gpu)"
get python3-pytest
# What PyPI's newer tools check (types, notebooks) is left to the wheel's test.
quietly env PYTHONDONTWRITEBYTECODE=1 python3 -m pytest -q -p no:cacheprovider --basetemp="$here/made-by-tests" aspic/python/tests
tail -n 1 "$log"

echo "--- removal"
quietly apt-get purge -q -y aspic 'libaspic*' python3-aspic
left=$(traces)
[ -z "$left" ] || fail "removal leaves $left"
[ -z "$(dpkg-query -W -f '${db:Status-Abbrev}${Package} ' '*aspic*' 2>/dev/null | grep -v '^un' || true)" ] || fail "dpkg knows of it still"
echo "nothing is left"
