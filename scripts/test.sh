#!/usr/bin/env bash
# Installs what is missing, builds Release, runs every test and then each fuzzer for ten seconds. With arguments, which go to
# ctest, the fuzzers are left out: scripts/test.sh -R EqualBits
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

aspic_install all
aspic_build ON
ctest --test-dir "$aspic_build_dir" --output-on-failure --no-tests=error -j "$(nproc)" "$@"
[ $# -gt 0 ] || scripts/fuzz.sh 10
