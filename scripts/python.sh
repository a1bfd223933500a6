#!/usr/bin/env bash
# python.sh [exports|docs]: makes build/python, the environment that builds and tests the Python package, from PyPI; with `exports` also
# build/exports, which has the libraries that read what it exports (600 MB), and with `docs` build/docs/python, which has those of
# scripts/docs.sh (200 MB). Nothing if it is up to date. Where PyPI is out of reach it says so and ends with exit code 1: then CMake leaves
# the package out, and the test `python` says that.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# make NAME REQUIREMENTS WHAT: build/NAME, without which WHAT are left out.
make() {
  local environment=$root/build/$1 wanted=$root/$2
  cmp -s "$wanted" "$environment/requirements.txt" && return
  echo "Making build/$1 from PyPI ($2)." >&2
  rm -rf "$environment"
  if /usr/bin/python3 -m venv "$environment" >&2 &&
    "$environment/bin/pip" install --quiet --disable-pip-version-check --retries 1 --timeout 20 -r "$wanted" >&2; then
    cp "$wanted" "$environment/requirements.txt"
  else
    rm -rf "$environment"
    echo "$3 are left out: PyPI is out of reach, or python3-venv is missing." >&2
    exit 1
  fi
}
make python python/requirements.txt "The Python package and its tests"
case ${1:-} in
  exports) make exports python/requirements-exports.txt "The tests that read exports" ;;
  docs) make docs/python docs/requirements.txt "The documentation site and its test" ;;
esac
