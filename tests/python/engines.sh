#!/usr/bin/env bash
# engines.sh ROOT PROGRAM PACKAGE: sweeps on Dask and submitit, and tables of pandas, from PyPI (python/requirements-engines.txt), with the Python
# package in the folder PACKAGE. Where PyPI is out of reach it says so and ends with exit code 77.
set -euo pipefail
root=$1 program=$2 package=$3
python=$root/build/python/bin/python engines=$root/build/python-engines wanted=$root/python/requirements-engines.txt
if ! cmp -s "$wanted" "$engines/requirements.txt"; then
  rm -rf "$engines"
  grep -v '^#' "$root/python/requirements.txt" >"$engines.constraints"
  if ! "$python" -m pip install --quiet --disable-pip-version-check --retries 1 --timeout 20 --target "$engines" \
    --constraint "$engines.constraints" -r "$wanted"; then
    rm -rf "$engines"
    echo "Skipped: PyPI is out of reach, so Dask and submitit are not here."
    exit 77
  fi
  cp "$wanted" "$engines/requirements.txt"
fi
cd "$(mktemp -d)"
trap 'rm -rf "$PWD"' EXIT
export PYTHONPATH=$package:$engines ASPIC_PROGRAM=$program
"$python" -B -m pytest -q -p no:cacheprovider "$root/python/tests/test_sweep_engines.py"
"$python" -B -m pytest -q -p no:cacheprovider "$root/python/tests/test_pages.py" -k "sweep"
