# Sourced by debians.sh and package.sh, as root: Debians below a folder, each in a chroot of debootstrap.
# Usage: source scripts/chroots.sh; chroots_open FOLDER; make_chroot CHROOT 12|13; copy_tree CHROOT; inside CHROOT COMMAND …
# Packages come from ASPIC_DEBIAN_MIRROR, by default from the mirror that apt uses here.

declare -A codename=([12]=bookworm [13]=trixie)

# chroots_open FOLDER: sets `folder`, its absolute path, and `mirror`.
chroots_open() {
  [ "$(id -u)" -eq 0 ] || { echo "debootstrap and chroot need root: run this script with sudo." >&2; return 1; }
  command -v debootstrap >/dev/null || { echo "debootstrap is missing: apt-get install debootstrap" >&2; return 1; }
  mirror=${ASPIC_DEBIAN_MIRROR:-$(apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Created-By: Packages' 2>/dev/null |
    awk '$1 == "Debian" { print $2; exit }')}
  [ -n "$mirror" ] || { echo "apt uses no Debian mirror here: set ASPIC_DEBIAN_MIRROR to the address of one." >&2; return 1; }
  mkdir -p "$1"
  folder=$(cd "$1" && pwd)
}

# make_chroot CHROOT 12|13: where there is none.
make_chroot() {
  local log=$1-bootstrap.log
  if [ ! -e "$1/etc/debian_version" ]; then
    echo "Debian $2: debootstrap into $1" >&2
    debootstrap --variant=minbase "${codename[$2]}" "$1" "$mirror" >"$log" 2>&1 || { tail -n 30 "$log" >&2; return 1; }
  fi
  cp -L /etc/resolv.conf "$1/etc/resolv.conf"
  # Where PyPI is behind certificates that this machine's pip is told to trust, the chroot's pip is told too.
  if [ -n "${PIP_CERT:-}" ]; then
    install -D -m 644 "$PIP_CERT" "$1/root/.config/pip/certificates.crt"
    printf '[global]\ncert = /root/.config/pip/certificates.crt\n' >"$1/root/.config/pip/pip.conf"
  fi
}

# inside CHROOT COMMAND …: without the caller's environment. Mounts and processes end with the command.
inside() {
  local debian=$1
  shift
  unshare --mount --pid --fork --kill-child bash -c '
    mount -t proc proc "$0/proc" && mount -t sysfs sys "$0/sys" && mount --rbind /dev "$0/dev" &&
      mount -t tmpfs -o mode=1777 shm "$0/dev/shm" || exit
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 "$@"' "$debian" "$@"
}

# copy_tree CHROOT: the tracked files, and the build as it was left.
copy_tree() {
  local tree=$1/root/aspic
  mkdir -p "$tree"
  find "$tree" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
  (cd "$root" && git ls-files -z | while IFS= read -r -d '' file; do [ -e "$file" ] && printf '%s\0' "$file"; done |
    tar --create --null --files-from=- --owner=0 --group=0) | tar --extract --directory "$tree"
}
