#!/usr/bin/env bash
# Makes build/wasm/aspic.wasm, the reference solver as WebAssembly, which pages of --html-live run; the next build embeds it. The compiler
# comes from PyPI (ziglang, in the environment build/wasm/python), since Debian 12's clang has no WASI library and Debian 13's Emscripten
# a C++ library without ranges. Where PyPI is out of reach it says so and ends with exit code 1: then the program is built without the
# module, --html-live says how to get it, and its tests are left out. Nothing is made again that is up to date.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
wanted=ziglang==0.17.1
made=$root/build/wasm
environment=$made/python
mkdir -p "$made/include"

if [ "$(cat "$environment/wanted" 2>/dev/null)" != "$wanted" ]; then
  echo "Making build/wasm/python from PyPI ($wanted)." >&2
  rm -rf "$environment"
  if /usr/bin/python3 -m venv "$environment" >&2 &&
    "$environment/bin/pip" install --quiet --disable-pip-version-check --retries 1 --timeout 20 "$wanted" >&2; then
    echo "$wanted" >"$environment/wanted"
  else
    rm -rf "$environment"
    echo "Pages that simulate, and their tests, are left out: PyPI is out of reach, or python3-venv is missing." >&2
    exit 1
  fi
fi

# Headers of the machine's own C++ library must not be found: those of the libraries alone are shown.
ln -sfn /usr/include/fmt "$made/include/fmt"
ln -sfn /usr/include/eigen3/Eigen "$made/include/Eigen"
ln -sfn /usr/include/toml++ "$made/include/toml++"

# What a browser needs, without files and devices.
cd "$root"
sources=(src/base/{flush_denormals,printable,result,suggestion,wording}.cpp src/model/*.cpp src/physics/contact/*.cpp src/collision/*.cpp src/cpu_reference/*.cpp src/analysis/energy.cpp
  src/scene/{actuator_rows,aim,body_rows,diagnostics,document,follow,keys,nesting,override_choices,overrides,parameter_table,parameters,parse,reader,reader_checks,scene_checks,short_keys,write}.cpp src/live/*.cpp)

# The same arithmetic as everywhere (docs/determinism.md): no contraction, no fast-math. WebAssembly has no exceptions yet.
flags="--target=wasm32-wasi -std=c++20 -O2 -ffp-contract=off -fno-exceptions -fvisibility=hidden -DNDEBUG -DFMT_HEADER_ONLY
  -DFMT_EXCEPTIONS=0 -D_LIBCPP_HAS_FILESYSTEM=1 -Iinclude -Isrc -isystem build/wasm/include -w"
{
  echo "ninja_required_version = 1.10"
  echo "builddir = build/wasm"
  echo "rule compile"
  echo "  command = $environment/bin/python -m ziglang c++ ${flags//$'\n'/ } -MMD -MF \$out.d -c \$in -o \$out"
  echo "  depfile = \$out.d"
  echo "  deps = gcc"
  echo "rule link"
  echo "  command = $environment/bin/python -m ziglang c++ --target=wasm32-wasi -mexec-model=reactor -O2 -s \$in -o \$out"
  # As pages hold it: a raw deflate stream.
  echo "rule pack"
  echo "  command = $environment/bin/python -c \"import sys, zlib; c = zlib.compressobj(9, zlib.DEFLATED, -15); open(sys.argv[2], 'wb').write(c.compress(open(sys.argv[1], 'rb').read()) + c.flush())\" \$in \$out"
  objects=()
  for source in "${sources[@]}"; do
    object=build/wasm/objects/${source#src/}.o
    objects+=("$object")
    echo "build $object: compile $source"
  done
  echo "build build/wasm/aspic.wasm: link ${objects[*]}"
  echo "build build/wasm/module/aspic.wasm.deflate: pack build/wasm/aspic.wasm"
} >"$made/build.ninja.new"
cmp -s "$made/build.ninja.new" "$made/build.ninja" || cp "$made/build.ninja.new" "$made/build.ninja"
export ZIG_GLOBAL_CACHE_DIR=$made/cache ZIG_LOCAL_CACHE_DIR=$made/cache
ninja --quiet -f build/wasm/build.ninja build/wasm/module/aspic.wasm.deflate >&2
