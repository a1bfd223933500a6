#!/usr/bin/env bash
# Installs what is missing, builds Release and runs every test. Arguments go to ctest: scripts/test.sh -R EqualBits
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

aspic_install all
aspic_build ON
exec ctest --test-dir "$aspic_build_dir" --output-on-failure --no-tests=error -j "$(nproc)" "$@"
