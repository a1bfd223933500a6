#!/usr/bin/env bash
# Writes tests/data/hashes.json again, by the reference alone: for changes that are meant to alter bits. Shows what changed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

aspic_install all
aspic_build ON golden_hashes
"$aspic_build_dir/tests/support/golden_hashes" "$aspic_root/tests/data/hashes.json.new"
mv "$aspic_root/tests/data/hashes.json.new" "$aspic_root/tests/data/hashes.json"
git -C "$aspic_root" diff --stat -- tests/data/hashes.json
