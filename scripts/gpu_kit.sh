#!/bin/bash
# Makes a folder that measures Aspic on a machine with a GPU and nothing installed: program, libraries, scenes, peers'
# sources, and run.sh, the one command there (docs/gpu.md).
# Usage: scripts/gpu_kit.sh [DIRECTORY]     default: build/gpu-kit
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
kit=${1:-$aspic_root/build/gpu-kit}
most_mebibytes=60

aspic_install run
aspic_build OFF aspic peer_textbook
rm -rf "$kit"
mkdir -p "$kit/bin/bench" "$kit/lib/cxx" "$kit/lib/loader" "$kit/bench" "$kit/scenes"
strip -o "$kit/bin/aspic" "$aspic_build_dir/aspic"
strip -o "$kit/bin/bench/peer_textbook" "$aspic_build_dir/bench/peer_textbook"
cp "$aspic_root"/assets/scenes/*.toml "$kit/scenes"
cp -r "$aspic_root/bench/kit" "$kit/bench/kit"
mkdir "$kit/bench/peers"
cp "$aspic_root"/bench/peers/{README.md,peers.txt,lattice.h,cuda_peer.cu,textbook.cpp,peer.h} "$kit/bench/peers"
mv "$kit/bench/kit/run.sh" "$kit/run.sh"
cp "$aspic_root/LICENSE" "$kit"

# The C library is the machine's; its C++ library and EGL loader go first where it has them.
ldd "$kit/bin/aspic" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }' | while read -r name file; do
  case $name in
    libc.so.* | libm.so.* | libpthread.so.* | libdl.so.* | librt.so.* | ld-linux*) ;;
    libstdc++.so.* | libgcc_s.so.*) cp -L "$file" "$kit/lib/cxx/$name" ;;
    *) cp -L "$file" "$kit/lib/$name" ;;
  esac
done
# The EGL loader is no part of what ldd lists: it is loaded when it is needed.
for name in libEGL.so.1 libGLdispatch.so.0; do cp -L "$(c++ -print-file-name="$name")" "$kit/lib/loader/$name"; done

size=$(du -sm "$kit" | cut -f1)
if [ "$size" -gt "$most_mebibytes" ]; then
  echo "The kit takes $size MiB, more than $most_mebibytes." >&2
  exit 1
fi
needs=$(objdump -T "$kit/bin/aspic" "$kit"/lib/*.so* | grep -o 'GLIBC_[0-9.]*' | sort -Vu | tail -1)
echo "$kit: $size MiB, for a C library from ${needs/GLIBC_/glibc } on. There: ./run.sh" >&2
