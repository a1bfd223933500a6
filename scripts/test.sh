#!/usr/bin/env bash
# Installs what is missing, builds, and runs the core tests, or all with --full. scripts/test.sh --help tells what the tiers have.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage() {
  cat <<'END'
scripts/test.sh                      the core tier, for every change: minutes on two cores after the build
scripts/test.sh --full               all tests, before a release: an hour on two cores after the build
scripts/test.sh [--full] ARGUMENT …  with arguments of ctest. -R, -L and -I choose from both tiers:
                                     scripts/test.sh -R EqualBits; scripts/test.sh -L drivers

core      each room's own tests; the gpu solvers on llvmpipe with a covering set of methods, terrains, contact
          models, force paths and bodies; images; the command line, its manual pages and completion; the Python
          package; the window's main tests; each scene of the independent implementation once
full      core, and by label:
  pages        pages of every built-in scene in Chromium and Firefox; pages that simulate, with every scene and method, which are
               skipped where scripts/wasm.sh has made no module
  docs         the documentation site of two scenes (scripts/docs.sh): no warning, no dead link, known names in it
  products     equal bits in products of methods, terrains, scenes and paths, and for more particles; cubes that come to rest
               and stick, under the rest of the explicit methods
  drivers      every kernel as every set of defines makes it, with 1 and 8 driver threads, on zink and for
               Khronos' reference compiler
  crowds       hundreds of balls in one place
  framing      how much of the image bodies fill, in every built-in scene, and what still backgrounds are kept of
  verify       aspic verify --quick, and wrong solvers that its slow rows notice
  window       the rest of the window's tests
  report       the report's page in a browser, and on paper
  examples     the commands of the documents, shortened
  independent  the independent implementation of the physics, under every method
  packages     the Python package from source distribution to wheel to a fresh environment; its sweeps on Dask and submitit;
               its notebooks; the cube that learns to crawl and the robots that evolve, to the end
  install      an installed library, used by a project outside of the tree; the programs of docs/library.md
  exports      files for other programs, read by VTK, USD, trimesh, zarr and xarray from PyPI (600 MB),
               and by Blender's library (1 GB)
  attack       damaged files and bytes, limits, faults and kills (scripts/attack.sh)
          and without a label:
  sanitizers   core once more, built with clang's address and undefined-behavior sanitizers, without the three longest runs
               of bodies on the reference, whose code other tests run as well
  fuzzers      ten seconds each (scripts/fuzz.sh)

Left to scripts/check.sh: most of the full tier under sanitizers, the thread sanitizer, clang-tidy, types of all translation units.
Left to scripts/debians.sh and scripts/package.sh: both Debians, and packages in empty ones.
END
}

full=no
arguments=()
for argument in "$@"; do
  case $argument in
    --help | -h)
      usage
      exit
      ;;
    --full) full=yes ;;
    *) arguments+=("$argument") ;;
  esac
done

tier=()
if [ "$full" = no ]; then
  tier=(-LE '^full$')
  for argument in "${arguments[@]}"; do
    # Tests that are asked for by name are run whatever their tier.
    case $argument in -LE*) ;; -R* | -L* | -I* | --tests-regex* | --label-regex* | --tests-information* | --rerun-failed) tier=() ;; esac
  done
fi

aspic_install all
aspic_python
if [ "$full" = yes ]; then aspic_wasm; fi
aspic_build ON
ctest --test-dir "$aspic_build_dir" --output-on-failure --no-tests=error -j "$(nproc)" "${tier[@]}" "${arguments[@]}"
if [ "$full" = yes ] && [ "${#arguments[@]}" -eq 0 ]; then
  cmake --preset asan-core
  ninja -C build/asan-core --quiet
  ctest --preset asan-core --no-tests=error -j "$(nproc)"
  scripts/fuzz.sh 10
fi
