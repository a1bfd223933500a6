#!/bin/bash
# Measures Aspic on this machine's GPU: what it is, whether it computes right, how fast it is and how fast it starts. No installation:
# it needs a driver with EGL and OpenGL 4.3, the C library, and these files.
# Usage: ./run.sh [--quick] [--minutes N] [--jobs N] [--wheels FOLDER] [DIRECTORY]     results go to DIRECTORY, by default results-DATE here
#   --quick          small sizes and few steps, for software rasterizers and to try the kit
#   --minutes N      total time; default: 8. What has no time left is left out, and the report names it
#   --jobs N         processes on the card at once; default: 6, or the number of processors if that is less
#   --wheels FOLDER  Python wheels of Taichi and Warp, which are then measured too
# Environment: ASPIC_EGL_DEVICE chooses a device (aspic info lists them).
set -u
shopt -s nullglob
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
quick='' minutes=8 wheels='' out='' jobs=$(nproc)
[ "$jobs" -gt 6 ] && jobs=6
whole() { [[ $2 =~ ^[1-9][0-9]{0,4}$ ]] || { echo "$1 takes a whole number from 1 to 99999." >&2; exit 2; }; }
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=1 ;;
    --minutes) whole "$1" "${2-}"; minutes=$2; shift ;;
    --jobs) whole "$1" "${2-}"; jobs=$2; shift ;;
    --wheels) wheels=$(realpath "${2-}") || exit 2; shift ;;
    -*) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 2 ;;
    *) out=$1 ;;
  esac
  shift
done
out=${out:-$here/results-$(date -u +%Y%m%d-%H%M%S)}
mkdir -p "$out"/{compare,tests,bench,start} || exit 6
out=$(realpath "$out")
export PATH=$PATH:/sbin:/usr/sbin:/usr/local/cuda/bin
export aspic=$here/tree/build/release/aspic out here

# The system's own C++ library and EGL loader come first: its driver was built for them.
own=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
ldconfig -p | grep -q 'libEGL\.so\.1 ' || own=$own:$here/lib/loader
for more in "" ":$here/lib/cxx"; do
  export LD_LIBRARY_PATH=$own$more
  "$aspic" --version >"$out/version.txt" 2>"$out/start.log" && break
done
[ -s "$out/version.txt" ] || { echo "aspic does not start here:" >&2; cat "$out/start.log" >&2; exit 6; }
# A container may have NVIDIA's driver and not its description for the loader, which then takes Mesa.
for file in /usr/local/nvidia/share /etc /usr/share; do
  file=$file/glvnd/egl_vendor.d/10_nvidia.json
  [ -z "${__EGL_VENDOR_LIBRARY_FILENAMES-}" ] && [ -e "$file" ] && export __EGL_VENDOR_LIBRARY_FILENAMES=$file
done

# stage NAME SHARE: what follows has to end within SHARE percent of the total time.
begun=$EPOCHSECONDS
stage() { export end=$((begun + minutes * 60 * $2 / 100)); echo "[$((EPOCHSECONDS - begun)) s] $1, until $((end - begun)) s" >&2; }
left_out() { printf -- '- %s: %s\n' "$1" "$2" >>"$out/left-out.txt"; }
# within NAME LIMIT FILE command …: its output goes to FILE, its messages to FILE.err; LIMIT seconds at most, and none beyond the
# stage. A command that fails ends nothing.
within() {
  local name=$1 limit=$2 file=$out/$3 status left=$((end - EPOCHSECONDS))
  shift 3
  [ "$left" -lt 2 ] && { left_out "$name" "no time left"; return 1; }
  { timeout -k 5 $((left < limit ? left : limit)) "$@" >"$file" 2>"$file.err"; } 2>/dev/null
  status=$?
  case $status in
    124 | 137) left_out "$name" "did not end within $((left < limit ? left : limit)) s" ;;
  esac
  return $status
}
# side_by_side FUNCTION: with the words of each line of the input, $jobs at once, each in a shell of its own.
side_by_side() {
  export -f within left_out "$1"
  xargs -P "$jobs" -L 1 bash -c "$1"' "$@"' "$1"
}
value() { sed -n 's/^ *"'"$2"'": "\{0,1\}\(.*[^",]\)"\{0,1\},*$/\1/p' "$out/$1"; }  # value FILE KEY, of each line with it

stage "info" 10
within info 40 info.txt "$aspic" info
within "info as JSON" 40 info.json "$aspic" info --json
command -v nvidia-smi >/dev/null && within nvidia-smi 20 nvidia-smi.txt nvidia-smi
if ! within "first step" 60 first.json "$aspic" run cube-plane --backend gpu --steps 1 --json; then
  echo "No step was made on a GPU; $out/first.json.err says why." >&2
  exit 4
fi
renderer=$(value info.json renderer | head -1)
software=$(value info.json software | tail -1)
echo "The device is $renderer." >&2
[ "$software" = true ] && echo "Warning: $renderer is a software rasterizer. No figure below is a GPU's." >&2

stage "all scenes and methods compared with the reference" 42
compare() {  # compare scene method steps
  local file=compare/$1-$2.json status same
  within "compare $1, $2" 60 "$file" "$aspic" compare "$1" --backends gpu,reference --steps "$3" --json --set "simulation.integrator=$2"
  status=$?
  [ -e "$out/$file" ] || return
  same=$(sed -n 's/^ *"identical": \([a-z]*\).*/\1/p' "$out/$file")
  case $same in
    true) same=identical ;;
    false) same="different from step $(sed -n 's/^ *"first_differing_step": \([0-9]*\).*/\1/p' "$out/$file")" ;;
    *) same="no result, exit code $status" ;;
  esac
  printf '%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$same" >>"$out/compare.tsv"
}
methods="explicit-euler runge-kutta-4 implicit-euler"
for scene in $("$aspic" scene list | awk '/^  / { print $1 }'); do
  for method in $methods; do
    steps=200
    [ -n "$quick" ] && steps=10
    [ "$scene" = large-cube ] && steps=$((steps / 20 + 1))
    echo "$scene $method $steps"
  done
done | side_by_side compare

stage "tests" 68
# Their binaries name files by the path of the checkout that they were built in.
root=$(cat "$here/tree/root.txt")
if [ ! -e "$root" ]; then
  mkdir -p "$(dirname "$root")" && ln -s "$here/tree" "$root" ||
    left_out "tests that read files of the checkout" "$root cannot be made here"
fi
gl_test() {  # gl_test program filter shard shards
  local name=${1##*/} status
  export ASPIC_TEST_DEVICE=$device GTEST_SHARD_INDEX=$3 GTEST_TOTAL_SHARDS=$4
  within "$name, part $(($3 + 1)) of $4" 200 "tests/$name-$3.log" "$here/tree/build/release/$1" "--gtest_filter=$2"
  status=$?
  printf '%s\t%s\n' "$name, part $(($3 + 1)) of $4" $status >>"$out/tests.tsv"
}
export device=hardware
[ "$software" = true ] && device=software
[ -n "$quick" ] && quick_filter=gpu_tests
while read -r program filter; do
  [[ $program == *${quick_filter-}* ]] || { left_out "${program##*/}" "--quick"; continue; }
  shards=1
  [[ $program =~ gpu_solver_gl|render|equal_bits ]] && shards=4
  for ((shard = 0; shard < shards; ++shard)); do echo "$program $filter $shard $shards"; done
done <"$here/tree/gl_tests.txt" | side_by_side gl_test

stage "throughput" 84
bench() {  # bench NAME BACKEND size …: as many simulated milliseconds, which are steps, as make figures steady
  local name=$1 backend=$2 size steps
  shift 2
  for size in "$@"; do
    case $size in 20) steps=4000 ;; 64 | 100) steps=1000 ;; 128) steps=500 ;; 200) steps=200 ;; *) steps=100 ;; esac
    local program=("$aspic" bench)
    [ -z "${peer-}" ] || program=("$aspic-peers" --peer "$peer")
    within "bench $name, $size" 60 "bench/$name-$(printf %03d "$size").json" "${program[@]}" --backend "$backend" --size "$size" \
      --integrator explicit-euler --duration "$((steps / 1000)).$(printf %03d $((steps % 1000)))" --repeats 3 --json ||
      left_out "bench $name, $size" "exit code $?"
  done
}
sizes="20 64 100 128 200" few="20 64 100"
[ -n "$quick" ] && sizes="6 10" few=10
bench exact gpu $sizes
bench fast gpu:fast $sizes
bench cpu cpu $few
bench gather gpu:gather $few

stage "other programs" 92
if command -v nvcc >/dev/null; then
  mkdir -p "$here/tree/build/release/bench"
  within "build of the CUDA peer" 60 cuda-build.txt nvcc -O3 -std=c++17 -arch=native "$here/tree/bench/peers/cuda_peer.cu" \
    -o "$here/tree/build/release/bench/peer_cuda" && [ "$software" != true ] && peer=cuda bench peer-cuda gpu $few
else
  left_out "peer cuda" "nvcc was not found"
fi
if [ -n "$wheels" ]; then
  venv=$here/tree/build/peers/venv
  [ "$software" = true ] || export ASPIC_PEER_DEVICE=cuda
  { [ -x "$venv/bin/python" ] || within "environment of the Python peers" 30 venv.txt python3 -m venv "$venv"; } &&
    for name in taichi warp; do
      within "installation of $name" 60 "$name-install.txt" "$venv/bin/pip" install --no-index --find-links "$wheels" \
        "$(sed -n "s/^\($name\(-lang\)\{0,1\}\)=.*/\1/p" "$here/tree/bench/peers/requirements.txt")" numpy &&
        peer=$name bench "peer-$name" gpu $few
    done
else
  left_out "peers taichi and warp" "no folder was given with --wheels"
fi

stage "start-up" 99
for scene in cube-plane ball-pit heap "cube-plane --set simulation.integrator=implicit-euler"; do
  cache=$out/start/cache
  rm -rf "$cache"
  mkdir -p "$cache"
  for kind in cold warm; do
    since=${EPOCHREALTIME/[.,]/}
    # The caches of NVIDIA's driver, of Mesa, and Aspic's own.
    if __GL_SHADER_DISK_CACHE_PATH=$cache MESA_SHADER_CACHE_DIR=$cache XDG_CACHE_HOME=$cache \
      within "start of $scene, $kind" 40 start/run.json "$aspic" run $scene --backend gpu --steps 1 --json; then
      printf '%s\t%s\t%d\n' "$scene" $kind $(((${EPOCHREALTIME/[.,]/} - since) / 1000)) >>"$out/start.tsv"
    else
      left_out "start of $scene, $kind" "failed"
    fi
  done
  rm -rf "$cache"
done

LC_ALL=C awk -v out="$out" -f "$here/report.awk" "$out/info.json" "$out"/*.tsv "$out"/tests/*.log "$out"/bench/*.json >"$out/report.md"
{ printf '\n## Left out\n\n'; sort -u "$out/left-out.txt" 2>/dev/null || echo none; } >>"$out/report.md"
echo "[$((EPOCHSECONDS - begun)) s] Report: $out/report.md" >&2
echo "$out"
