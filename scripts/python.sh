#!/usr/bin/env bash
# Makes build/python, the environment that builds and tests the Python package, from PyPI; nothing if it is up to date. Where PyPI
# is out of reach it says so and ends with exit code 1: then CMake leaves the package out, and the test `python` says that.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
environment=$root/build/python
wanted=$root/python/requirements.txt
cmp -s "$wanted" "$environment/requirements.txt" && exit 0
echo "Making build/python from PyPI (python/requirements.txt)." >&2
rm -rf "$environment"
if /usr/bin/python3 -m venv "$environment" >&2 &&
  "$environment/bin/pip" install --quiet --disable-pip-version-check --retries 1 --timeout 20 -r "$wanted" >&2; then
  cp "$wanted" "$environment/requirements.txt"
else
  rm -rf "$environment"
  echo "The Python package and its tests are left out: PyPI is out of reach, or python3-venv is missing." >&2
  exit 1
fi
