#!/usr/bin/env bash
# Compares reference and cpu with tests/data/hashes.json on 64-bit ARM: cross-compiles them into build/arm and runs them in QEMU.
# Takes an hour on two cores. Arguments go to GoogleTest: scripts/arm.sh --gtest_filter='*explicit_euler'
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
aspic_install all
aspic_install_packages g++-aarch64-linux-gnu qemu-user libgtest-dev
aspic_build ON aspic_scene aspic_mesh
cmake -S "$aspic_root/tests/arm" -B "$aspic_root/build/arm" -G Ninja -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ >&2
cmake --build "$aspic_root/build/arm" >&2
exec qemu-aarch64 "$aspic_root/build/arm/hashes" "$@"
