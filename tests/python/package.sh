#!/usr/bin/env bash
# package.sh ROOT PROGRAM BUILD: what a user gets. The source distribution, a wheel built from it alone, which is installed in a fresh environment
# without an index; there the package's own tests run, from the source distribution and outside of the tree. And a wheel with the library
# that BUILD installs.
set -euo pipefail
root=$1 program=$2 build=$3
python=$root/build/python/bin/python
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# What needs PyPI: the interpreters' own packages. Nothing below asks for anything else.
grep -v '^#' "$root/python/requirements.txt" >"$place/requirements.txt"
"$python" -m pip download --quiet --disable-pip-version-check --dest "$place/kept" abi3audit==0.0.26 twine==7.0.0 check-wheel-contents==0.6.3 -r "$place/requirements.txt"
quietly() { "$@" >"$place/log" 2>&1 || { cat "$place/log"; echo "$* failed"; exit 1; }; }
offline=(--quiet --disable-pip-version-check --no-index --find-links "$place/kept")

(cd "$root" && quietly "$python" -c "from scikit_build_core.build import build_sdist; print(build_sdist('$place/sdist'))")
sdist=$(echo "$place"/sdist/aspic_softbody-*.tar.gz)
[ "$(stat -c %s "$sdist")" -lt 10000000 ] || { echo "The source distribution has $(stat -c %s "$sdist") bytes."; exit 1; }
tar -xf "$sdist" -C "$place"
source=$(echo "$place"/aspic_softbody-*/)
quietly "$python" -m venv "$place/builder"
quietly "$place/builder/bin/pip" install "${offline[@]}" scikit-build-core nanobind nanobind-backend
# make_wheel FOLDER argument …
make_wheel() {
  local folder=$1
  shift
  quietly "$place/builder/bin/pip" wheel "${offline[@]}" --no-deps --no-build-isolation --wheel-dir "$folder" "$@" "$source"
  wheel=$(echo "$folder"/*.whl)
  echo "$(basename "$wheel"): $(stat -c %s "$wheel") bytes after $SECONDS s"
  [[ $wheel == */aspic_softbody-*-cp310-abi3-linux_*.whl ]] || { echo "The wheel is not for the stable ABI of Python 3.10."; exit 1; }
}
quietly cmake --install "$build" --prefix "$place/library" --component library
make_wheel "$place/quick" --config-settings "cmake.define.ASPIC_INSTALLED=$place/library"
quietly "$python" -m venv "$place/other"
quietly "$place/other/bin/pip" install "${offline[@]}" "$wheel"
first='import aspic; sim = aspic.Simulation("cube-bowl", "cpu"); sim.step(200); print(sim.hash)'
wanted=$("$program" run cube-bowl --backend cpu --steps 200 --json | "$python" -c 'import json, sys; print(json.load(sys.stdin)["state_hash"])')
got=$(cd "$place" && "$place/other/bin/python" -c "$first")
[ "$got" = "$wanted" ] || { echo "With the installed library the hash is $got, the program's $wanted."; exit 1; }
make_wheel "$place/wheel"

quietly "$python" -m zipfile -e "$wheel" "$place/content"
for part in _aspic.abi3.so _aspic.pyi __init__.py py.typed; do
  [ -s "$place/content/aspic/$part" ] || [ "$part" = py.typed ] || { echo "The wheel lacks $part."; exit 1; }
done
if find "$place/content" -name 'lib*' -o -name '*.h' -o -name '*.a' | grep .; then
  echo "The wheel contains what is none of the package."
  exit 1
fi
if readelf -d "$place/content/aspic/_aspic.abi3.so" | grep -E 'NEEDED.*lib(EGL|GL|X11|python|aspic)'; then
  echo "The extension module is linked to what it loads or contains."
  exit 1
fi

quietly "$python" -m venv "$place/user"
quietly "$place/user/bin/pip" install "${offline[@]}" aspic-softbody --find-links "$place/wheel"
installed=$("$place/user/bin/pip" list --disable-pip-version-check --format=freeze | grep -vE '^(pip|setuptools|wheel)==' | cut -d= -f1 | sort | tr '\n' ' ')
[ "$installed" = "aspic-softbody nanobind-backend numpy " ] || { echo "Installing aspic-softbody brought $installed"; exit 1; }
# One wheel for every Python: another one than the builder's, if there is one.
for other in python3.1{0..4}; do
  [ "$("$other" -c 'import sys; print(sys.version_info[:2])' 2>/dev/null)" != "$("$python" -c 'import sys; print(sys.version_info[:2])')" ] || continue
  "$other" -m venv "$place/second" >/dev/null 2>&1 || continue
  quietly "$place/second/bin/pip" install --quiet --disable-pip-version-check "$wheel"
  got=$(cd "$place" && "$place/second/bin/python" -c "$first")
  [ "$got" = "$wanted" ] || { echo "With $other the hash is $got, the program's $wanted."; exit 1; }
  echo "$other: the same wheel, the same hash"
  break
done
quietly "$place/user/bin/pip" install "${offline[@]}" pytest mypy
# The checkers have an environment to themselves, since they bring much along.
quietly "$python" -m venv "$place/checker"
quietly "$place/checker/bin/pip" install "${offline[@]}" abi3audit twine check-wheel-contents
quietly "$place/checker/bin/abi3audit" --strict "$wheel"
quietly "$place/checker/bin/twine" check --strict "$sdist" "$wheel"
quietly "$place/checker/bin/check-wheel-contents" "$wheel"
cd "$place"
ASPIC_PROGRAM=$program "$place/user/bin/python" -B -m pytest -q -p no:cacheprovider "$source/python/tests"
# Also where there is no EGL: an empty file is none.
mkdir no-egl
touch no-egl/libEGL.so.1
LD_LIBRARY_PATH=$place/no-egl ASPIC_PROGRAM=$program "$place/user/bin/python" -B -m pytest -q -p no:cacheprovider "$source/python/tests"
