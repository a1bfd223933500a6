#!/bin/bash
# Compares Aspic with other programs that simulate the same cube, and prints the ratios: docs/performance.md.
# Usage: scripts/peers.sh [option of aspic bench …]; default: --backend cpu,reference --size 10,20,40
# Installs missing packages: Debian's, and PyPI's in a separate environment, build/peers/venv.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# Packages that only peers need, besides scripts/packages.txt.
peer_packages=(libbullet-dev python3-venv)

aspic_install all
aspic_install_packages "${peer_packages[@]}"
venv=$aspic_root/build/peers/venv
wanted=$aspic_root/bench/peers/requirements.txt
if ! cmp -s "$wanted" "$venv/installed.txt"; then
  echo "Installing Python packages in build/peers/venv" >&2
  python3 -m venv "$venv" >&2
  "$venv/bin/pip" install --quiet --disable-pip-version-check --requirement "$wanted" >&2
  cp "$wanted" "$venv/installed.txt"
fi
# CMake looks for Bullet when it configures.
[ -f "$aspic_build_dir/build.ninja" ] && ! grep -q '^bullet_FOUND:INTERNAL=1$' "$aspic_build_dir/CMakeCache.txt" &&
  touch "$aspic_root/bench/CMakeLists.txt"
aspic_build BENCH aspic_peers peer_textbook peer_bullet
[ $# -gt 0 ] || set -- --backend cpu,reference --size 10,20,40
exec "$aspic_build_dir/aspic-peers" "$@"
