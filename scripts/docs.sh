#!/usr/bin/env bash
# scripts/docs.sh [--external] [SCENE …]: the documentation as a site for any static host, build/docs/html: the pages of docs/, the APIs of
# Python and C++ and every built-in scene, or those named. Fails on a warning of Doxygen or Sphinx and on a link within the site that leads
# nowhere; --external also asks for the pages elsewhere that it links to. Scenes run live where scripts/wasm.sh has made the module.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
aspic_install docs
aspic_python
"$aspic_root/scripts/python.sh" docs
aspic_build OFF aspic python_module
"$aspic_root/build/docs/python/bin/python" "$aspic_root/docs/site/build.py" "$aspic_build_dir/aspic" "$aspic_build_dir/python" "$aspic_root/build/docs" "$@"
