#!/usr/bin/env bash
# scripts/site.sh FOLDER [SCENE …]: a site for any static host: every built-in scene (or those named) as a page that plays its run and as
# one that simulates it, the gallery and the documents. What it links to is in the folder, and nothing is loaded from elsewhere.
set -euo pipefail
folder=$(realpath -m "${1:?Usage: scripts/site.sh FOLDER [SCENE …]}")
shift
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
aspic_install run
"$aspic_root/scripts/wasm.sh"
aspic_build OFF aspic
/usr/bin/python3 "$aspic_root/scripts/site.py" "$aspic_build_dir/aspic" "$folder" "$@"
