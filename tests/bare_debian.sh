# Bare Debian systems in scratch folders, for the scripts here that need one; sourced by them.
# MIRROR=URL names the Debian mirror; otherwise it is the one that this machine's apt has.

fail() {
  echo "debian: $*" >&2
  exit 1
}

# make_system SUITE FOLDER: a system that has what Debian calls essential, apt, and the network of this machine.
make_system() {
  local suite="$1" system="$2" mirror log
  [ "$(id -u)" -eq 0 ] || fail "only root can make a system: sudo bash $0"
  command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
  mirror="${MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)}"
  [ -n "$mirror" ] || fail "this machine's apt has no Debian mirror: name one with MIRROR=URL"

  echo "debian: making a bare $suite"
  log="$system.log"
  debootstrap --variant=minbase "$suite" "$system" "$mirror" >"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    fail "debootstrap failed"
  }
  cp /etc/resolv.conf "$system/etc/resolv.conf"
  apt-config dump | grep -E '^Acquire::https?::Proxy' >"$system/etc/apt/apt.conf.d/proxy" || true
  echo force-unsafe-io >"$system/etc/dpkg/dpkg.cfg.d/speed" # a system that does not outlive a power failure need not be on the disk
}

# inside FOLDER COMMAND...: runs it as root in that system, in namespaces of its own, so that the mounts and all processes end with it.
inside() {
  local system="$1"
  shift
  unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$0/proc"
    mount -t tmpfs tmpfs "$0/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts"
    exec chroot "$0" env -i "$@"' \
    "$system" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-2}" "$@"
}
