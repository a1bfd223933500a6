#!/bin/bash
# Measures Aspic on this machine's GPU: what it is, whether it computes right, and how fast. No installation: it needs
# a driver with EGL and OpenGL 4.3, the C library, and these files. Where nvcc is, the CUDA baseline is built and run too.
# Usage: ./run.sh [--quick] [--minutes N] [DIRECTORY]     results go to DIRECTORY, by default results-DATE next to this file
#   --quick      small sizes and few steps, for software rasterisers and to try the kit: minutes instead of an hour
#   --minutes N  what has not begun after so many minutes is left out, and the report names it; default: 120. A third at most
#                is for verify, and the comparisons begin within two thirds
# Environment: ASPIC_EGL_DEVICE chooses a device (aspic info lists them).
set -u
shopt -s nullglob
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
quick=
minutes=120
out=
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=1 ;;
    --minutes)
      minutes=${2-}
      shift
      [[ $minutes =~ ^[1-9][0-9]{0,4}$ ]] || { echo "--minutes takes a whole number from 1 to 99999." >&2; exit 2; }
      ;;
    -*) sed -n '2,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
out=${out:-$here/results-$(date -u +%Y%m%d-%H%M%S)}
mkdir -p "$out/bench" "$out/compare" "$out/frames" || exit 6
aspic=$here/bin/aspic

# The system's own C++ library and EGL loader come first: its driver was built for them.
own=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
for more in "" ":$here/lib/cxx" ":$here/lib/loader" ":$here/lib/cxx:$here/lib/loader"; do
  export LD_LIBRARY_PATH=$own$more
  "$aspic" --version >"$out/version.txt" 2>"$out/start.log" && break
done
if [ ! -s "$out/version.txt" ]; then
  echo "aspic does not start here:" >&2
  cat "$out/start.log" >&2
  exit 6
fi

leave_out() { printf -- '- %s: %s\n' "$1" "$2" >>"$out/left-out.txt"; }

# step NAME FILE command …: its output goes to FILE, its messages and how it ended to the log. A step that fails ends nothing.
# Begins within $until sixtieths of the total time (60). Seconds it took: $took. An exit code of $also_fine is no failure either.
step() {
  local name=$1 file=$2 begun=$SECONDS status
  shift 2
  took=0
  if [ "$SECONDS" -ge $((${until:-60} * minutes)) ]; then
    leave_out "$name" "not begun in time"
    return 1
  fi
  echo "$name" >&2
  timeout "${limit:-600}" "$@" >"$out/$file" 2>>"$out/messages.log"
  status=$?
  took=$((SECONDS - begun))
  [ "$status" = "${also_fine:-0}" ] && status=0
  printf '%s\t%s\t%s\n' "$status" "$took" "$name" >>"$out/steps.tsv"
  return $status
}

if [ -n "$quick" ]; then
  sizes="4 6 10" cuda_sizes="10" middle=6 seconds=0.3 repeats=3 verify=--quick steps=10 patience=60
  integrators="explicit-euler implicit-euler"
else
  sizes="10 20 40 64 100 128 200 256" cuda_sizes="10 20 40 64 100 128 200" middle=40 seconds=3 repeats=5 verify="" steps=200 patience=120
  integrators="explicit-euler symplectic-euler midpoint runge-kutta-4 implicit-euler"
fi

step info info.txt "$aspic" info
step "info as JSON" info.json "$aspic" info --json
command -v nvidia-smi >/dev/null && step nvidia-smi nvidia-smi.txt nvidia-smi
if ! step "first step" first.json "$aspic" run cube-plane --backend gpu --steps 1 --json; then
  echo "No step was made on a GPU; $out/messages.log says why." >&2
  exit 4
fi
paths=
for path in lattice lattice-tiles gather per-spring; do
  "$aspic" run cube-plane --backend gpu --force-path $path --steps 1 >/dev/null 2>&1 && paths="$paths $path"
done

limit=$((20 * minutes)) step verify verify.json "$aspic" verify $verify --json
explicit_alone() { [ "$1" = per-spring ] || [ "$1" = lattice-tiles ]; }
declare -A fewer=()
compare() {  # compare scene integrator path: a tenth of the steps once one of the scene took longer than $patience
  local count=${fewer[$1]:-$steps}
  # Cloth diverges under explicit methods at its scene's step, on the reference as well: exit code 5.
  until=40 also_fine=5 limit=$((3 * patience)) step "compare $1, $2, $3" "compare/$1-$2-$3.json" \
    "$aspic" compare "$1" --backends "gpu:$3,reference" --steps "$count" --json --set "simulation.integrator=$2"
  if [ "$took" -gt $patience ] && [ "$count" = "$steps" ]; then
    fewer[$1]=$((steps / 10))
    leave_out "compare $1 beyond step ${fewer[$1]}" "$2, $3 took $took s"
  fi
}
for scene in $("$aspic" scene list | awk '{ print $1 }'); do
  for integrator in explicit-euler runge-kutta-4 implicit-euler; do
    for path in auto $paths; do
      [ -n "$quick" ] && [ "$path" != auto ] && [ "$scene" != cube-plane ] && continue
      [ $integrator = implicit-euler ] && explicit_alone "$path" && continue
      compare "$scene" $integrator "$path"
    done
  done
done

step picture picture.json "$aspic" run cube-bowl --backend gpu --duration 1.5 --frames "$out/frames" --fps 2 \
  --size 640x360 --force --json
pictures=("$out"/frames/*.png)
[ ${#pictures[@]} -gt 0 ] && cp "${pictures[-1]}" "$out/picture.png"

declare -A slow=()
bench() {  # bench NAME size integrator options …: none of a larger size after one that took longer than $patience
  local name=$1 size=$2 integrator=$3 file
  shift 3
  file=bench/$name-$integrator-$(printf %03d "$size").json
  [ -s "$out/$file" ] && return  # once is enough
  if [ -n "${slow[$name-$integrator]-}" ]; then
    leave_out "bench $name, $size, $integrator" "${slow[$name-$integrator]}"
    return
  fi
  step "bench $name, $size, $integrator" "$file" \
    "$aspic" bench --size "$size" --integrator "$integrator" --seconds $seconds --repeats $repeats --json "$@"
  [ "$took" -gt $patience ] && slow[$name-$integrator]="$size particles per edge took $took s"
}
for size in $sizes; do
  for path in $paths; do bench $path "$size" explicit-euler --backend gpu:$path; done
  bench cpu "$size" explicit-euler --backend cpu
done
for integrator in $integrators; do
  for path in $paths; do
    [ $integrator = implicit-euler ] && explicit_alone "$path" && continue
    bench $path $middle $integrator --backend gpu:$path
  done
done
[ -n "$quick" ] || for path in lattice gather; do
  case $paths in *$path*) bench $path 100 implicit-euler --backend gpu:$path ;; esac
done

if command -v nvcc >/dev/null || [ -x /usr/local/cuda/bin/nvcc ]; then
  PATH=$PATH:/usr/local/cuda/bin
  mkdir -p "$here/bin/bench"
  if step "build of the CUDA baseline" cuda-build.txt \
    nvcc -O3 -std=c++17 -arch=native "$here/bench/peers/cuda_peer.cu" -o "$here/bin/bench/peer_cuda" ||
    step "build of the CUDA baseline, for any card" cuda-build.txt \
      nvcc -O3 -std=c++17 "$here/bench/peers/cuda_peer.cu" -o "$here/bin/bench/peer_cuda"; then
    for size in $cuda_sizes; do
      bench cuda "$size" explicit-euler --backend gpu --peer cuda
    done
  fi
fi

{ printf '[\n'; separator=; for file in "$out"/bench/*.json; do
    [ -s "$file" ] && printf '%s' "$separator" && cat "$file" && separator=$',\n'
  done; printf ']\n'; } >"$out/bench.json"
LC_ALL=C awk -f "$here/bench/kit/report.awk" -v out="$out" "$out/info.json" "$out/verify.json" "$out"/compare/*.json \
  "$out"/bench/*.json >"$out/report.md"
LC_ALL=C awk -F'\t' '$1 != 0 { print "- " $3 ": " ($1 == 124 ? "did not end within " $2 " s" : "exit code " $1) }' "$out/steps.tsv" >"$out/failed.txt"
[ -s "$out/picture.png" ] && printf '\n## A picture\n\n![a cube in a bowl, drawn by the device](picture.png)\n' >>"$out/report.md"
for part in "Steps that failed:failed" "Left out:left-out"; do
  printf '\n## %s\n\n' "${part%:*}"
  if [ -s "$out/${part#*:}.txt" ]; then sort -u "$out/${part#*:}.txt"; else echo none; fi
done >>"$out/report.md"
echo "Report: $out/report.md" >&2
echo "$out"
