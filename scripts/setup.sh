# Sourced by run.sh, test.sh and package.sh: installs what is missing and builds Release. Everything it says goes to stderr.
# Usage: source scripts/setup.sh; aspic_install run|all|package|docs; aspic_install_packages name …; aspic_python; aspic_wasm; aspic_build ON|OFF|BENCH [ninja target …]

aspic_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
aspic_build_dir=$aspic_root/build/release

# aspic_packages run|all|package|docs: names from packages.txt.
aspic_packages() {
  awk -v who="$1" '!/^#/ && NF >= 2 && ($2 == "run" || $2 ~ (who == "all" ? "test" : who)) { print $1 }' \
    "$aspic_root/scripts/packages.txt"
}

aspic_install() {
  local wanted
  mapfile -t wanted < <(aspic_packages "$1")
  aspic_install_packages "${wanted[@]}"
}

# aspic_install_packages name …: those that are missing.
aspic_install_packages() {
  local wanted=("$@") missing package
  # dpkg-query prints nothing for a package it has never heard of: what is not listed as installed is missing.
  missing=$(comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) \
    <(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2>/dev/null | awk '$1 == "ii" { print $2 }' | sort -u))
  [ -z "$missing" ] && return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      printf 'Missing Debian packages, and neither root nor sudo to install them. As root, run:\n  apt-get install %s\n' \
        "$(tr '\n' ' ' <<<"$missing")" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing Debian packages: $(tr '\n' ' ' <<<"$missing")" >&2
  mapfile -t package <<<"$missing"
  {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${package[@]}"
  } >&2
}

# aspic_python: what builds and tests the Python package, as far as PyPI is in reach.
aspic_python() {
  local stamp=$aspic_root/build/python/requirements.txt before
  before=$(cat "$stamp" 2>/dev/null || true)
  "$aspic_root/scripts/python.sh" || true
  # CMake looks for it when it configures.
  if [ -f "$aspic_build_dir/build.ninja" ] && [ "$before" != "$(cat "$stamp" 2>/dev/null || true)" ]; then
    cmake "$aspic_build_dir" >&2
  fi
}

# aspic_wasm: the module of pages that simulate, as far as PyPI is in reach; the next build embeds it.
aspic_wasm() {
  "$aspic_root/scripts/wasm.sh" || true
}

# aspic_build ON|OFF|BENCH [target …]: ON has the tests built as well, BENCH also what measures. Ninja configures again by itself when a
# CMake file changed.
aspic_build() {
  local wanted=(-DASPIC_BUILD_TESTS=OFF) option
  case $1 in
    ON) wanted=(-DASPIC_BUILD_TESTS=ON) ;;
    BENCH) wanted=(-DASPIC_BUILD_TESTS=ON -DASPIC_BUILD_BENCH=ON) ;;
  esac
  shift
  cd "$aspic_root" || return 1
  for option in "${wanted[@]}"; do
    if [ -f "$aspic_build_dir/build.ninja" ]; then
      [[ $option == *=OFF ]] && continue # what is there already stays
      option=${option#-D}
      grep -qx "${option/=/:BOOL=}" "$aspic_build_dir/CMakeCache.txt" && continue
    fi
    # Files compiled together read the headers that they share once: half the time of a first build.
    cmake --preset release "${wanted[@]}" -DCMAKE_UNITY_BUILD=ON >&2 || return 1
    break
  done
  if ! ninja -C "$aspic_build_dir" --quiet "$@" | sed '/^ninja: no work to do/d' >&2; then
    echo "The build failed; the compiler's messages are above." >&2
    return 1
  fi
}
