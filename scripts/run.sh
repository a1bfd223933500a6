#!/usr/bin/env bash
# Installs what is missing, builds Release and runs aspic with the arguments given here. Without arguments: the window,
# where there is a display and it could be built, else cube-plane simulated and recorded headless into out/. Builds all programs
# where the window can be opened, for info, and for commands that other programs have.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

caller=$PWD
aspic_install run
target=aspic
case ${DISPLAY:-}${WAYLAND_DISPLAY:-}:${1:-} in
  ?*:* | :info | :view | :bench | :report | :sweep | :verify) target=programs ;;
esac
aspic_build OFF "$target"
aspic=$aspic_build_dir/aspic
cd "$caller"

if [ $# -gt 0 ]; then
  exec "$aspic" "$@"
fi
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && [ -x "$aspic_build_dir/aspic-view" ]; then
  exec "$aspic" view
fi
out=$aspic_root/out
mkdir -p "$out"
exec "$aspic" run cube-plane --duration 4 --video "$out/cube-plane.mp4" --series "$out/cube-plane.csv" --every 10 --force
