#!/bin/bash
# Makes a folder that measures and tests Aspic on a machine with a GPU and nothing installed: program, libraries, tests of the GPU,
# peers' sources, and run.sh, the one command there (docs/gpu.md).
# Usage: scripts/gpu_kit.sh [DIRECTORY]     default: build/gpu-kit
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
kit=${1:-$aspic_root/build/gpu-kit}
most_mebibytes=120

aspic_install run
aspic_install_packages libgtest-dev libgmock-dev
aspic_build ON aspic aspic-studies aspic_peers gl_tests
rm -rf "$kit"
tree=$kit/tree  # what the tests read lies where it is in the checkout
mkdir -p "$kit/lib/cxx" "$kit/lib/loader" "$tree/build/release" "$tree/bench/results/h200" "$tree/tests/data" "$tree/tests/gpu"
cp "$aspic_root/LICENSE" "$aspic_root"/bench/kit/{run.sh,report.awk} "$kit"
cp -r "$aspic_root/bench/peers" "$tree/bench"
cp -r "$aspic_root/shaders" "$tree"
cp -r "$aspic_root/tests/gpu/shaders" "$tree/tests/gpu"
cp "$aspic_root/tests/data/hashes.json" "$tree/tests/data"
cp "$aspic_root/bench/results/h200/hashes.csv" "$tree/bench/results/h200"
cp "$aspic_build_dir/gl_tests.txt" "$tree"
echo "$aspic_root" >"$tree/root.txt"
{ cut -d ' ' -f 1 "$tree/gl_tests.txt"; printf '%s\n' aspic aspic-studies aspic-peers; } | while read -r program; do
  mkdir -p "$(dirname "$tree/build/release/$program")"
  strip -o "$tree/build/release/$program" "$aspic_build_dir/$program"
done

# The C library is the machine's; its C++ library and EGL loader go first where it has them.
find "$tree/build/release" -type f -exec ldd {} + | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | sort -u | while read -r name file; do
  case $name in
    libc.so.* | libm.so.* | libpthread.so.* | libdl.so.* | librt.so.* | ld-linux*) ;;
    libstdc++.so.* | libgcc_s.so.*) cp -L "$file" "$kit/lib/cxx/$name" ;;
    libEGL.so.* | libGL*.so.* | libOpenGL.so.*) ;;
    *) cp -L "$file" "$kit/lib/$name" ;;
  esac
done
# A driver alone brings no loader, which is loaded when it is needed.
for name in libEGL.so.1 libGLdispatch.so.0 libOpenGL.so.0; do
  file=$(c++ -print-file-name="$name")
  [ ! -e "$file" ] || cp -L "$file" "$kit/lib/loader/$name"
done

size=$(du -sm "$kit" | cut -f1)
if [ "$size" -gt "$most_mebibytes" ]; then
  echo "The kit takes $size MiB, more than $most_mebibytes." >&2
  exit 1
fi
needs=$(objdump -T "$tree/build/release/aspic" "$kit"/lib/*.so* | grep -o 'GLIBC_[0-9.]*' | sort -Vu | tail -1)
echo "$kit: $size MiB, for a C library from ${needs/GLIBC_/glibc } on. There: ./run.sh" >&2
