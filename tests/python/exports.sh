#!/usr/bin/env bash
# exports.sh ROOT PROGRAM BUILD: what other programs' own libraries read in the files that the program and the package export, and what
# libigl and trimesh make of the meshes that the program reads.
set -euo pipefail
root=$1 program=$2 build=$3
"$root/scripts/python.sh" exports || { echo "Skipped: the libraries that read exports are not here."; exit 0; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"
ASPIC_PROGRAM=$program PYTHONPATH=$build/python ASPIC_WINDING_POINTS=$build/tests/mesh/winding_points \
  "$root/build/exports/bin/python" -B -m pytest -q -W error -p no:cacheprovider "$root/tests/python/exports_test.py" "$root/tests/python/winding_test.py"
