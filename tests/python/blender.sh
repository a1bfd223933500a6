#!/usr/bin/env bash
# blender.sh ROOT PROGRAM: loads what the program exports into Blender's library from PyPI (bpy, 1 GB with what it needs), by
# examples/blender/load_motion.py. Where PyPI is out of reach, or has none for this Python, it says so and ends with exit code 77.
set -euo pipefail
root=$1 program=$2
environment=$root/build/blender wanted=bpy==5.0.1
if [ "$(cat "$environment/installed.txt" 2>/dev/null)" != "$wanted" ]; then
  rm -rf "$environment"
  if ! { /usr/bin/python3 -m venv "$environment" &&
    "$environment/bin/pip" install --quiet --disable-pip-version-check --retries 1 --timeout 20 "$wanted"; }; then
    rm -rf "$environment"
    echo "Skipped: PyPI is out of reach, or has no $wanted for this Python."
    exit 77
  fi
  echo "$wanted" >"$environment/installed.txt"
fi
exec "$environment/bin/python" -B "$root/tests/python/blender_test.py" "$root" "$program"
