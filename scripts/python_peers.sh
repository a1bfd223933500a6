#!/bin/bash
# Compares the Python package with Newton and MuJoCo, the same cube in each, and prints a table: docs/python.md.
# Usage: scripts/python_peers.sh [--repeats 5] [--seconds 2] [--json]
# Builds the package, and installs what is missing from PyPI in build/python_peers (700 MB).
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

aspic_install all
aspic_python
aspic_build BENCH python_module
environment=$aspic_root/build/python_peers
wanted=$aspic_root/bench/python_peers/requirements.txt
if ! cmp -s "$wanted" "$environment/installed.txt"; then
  echo "Making build/python_peers from PyPI (bench/python_peers/requirements.txt)" >&2
  rm -rf "$environment"
  python3 -m venv "$environment" >&2
  "$environment/bin/pip" install --quiet --disable-pip-version-check --requirement "$wanted" >&2
  cp "$wanted" "$environment/installed.txt"
fi
PYTHONPATH=$aspic_build_dir/python exec "$environment/bin/python" "$aspic_root/bench/python_peers/compare.py" "$@"
