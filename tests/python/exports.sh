#!/usr/bin/env bash
# exports.sh ROOT PROGRAM BUILD: what other programs' own libraries read in the files that the program and the package export.
set -euo pipefail
root=$1 program=$2 build=$3
"$root/scripts/python.sh" exports || { echo "Skipped: the libraries that read exports are not here."; exit 0; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
ASPIC_PROGRAM=$program PYTHONPATH=$build/python "$root/build/exports/bin/python" -B -m pytest -q -W error -p no:cacheprovider "$root/tests/python/exports_test.py"
