#!/usr/bin/env bash
# Makes a bare Debian system, runs both commands of the README in a clone of what is committed here, and takes it away again.
#   sudo bash tests/debian.sh SUITE      bookworm or trixie; needs debootstrap, a network, 8 GB in $TMPDIR or /tmp, and half an hour
# MIRROR=URL names the Debian mirror; otherwise it is the one that this machine's apt has.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

fail() {
  echo "debian: $*" >&2
  exit 1
}

[ $# -eq 1 ] || fail "name one suite: bookworm or trixie"
suite="$1"
[ "$(id -u)" -eq 0 ] || fail "only root can make a system: sudo bash tests/debian.sh $suite"
command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
mirror="${MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | head -n 1)}"
[ -n "$mirror" ] || fail "this machine's apt has no Debian mirror: name one with MIRROR=URL"

scratch="$(mktemp -d)"
trap 'rm -rf --one-file-system "$scratch"' EXIT
trap 'exit 130' INT TERM HUP
system="$scratch/$suite"

echo "debian: making a bare $suite"
debootstrap --variant=minbase "$suite" "$system" "$mirror" >"$scratch/debootstrap.log" 2>&1 ||
  { tail -n 20 "$scratch/debootstrap.log" >&2; fail "debootstrap failed"; }
cp /etc/resolv.conf "$system/etc/resolv.conf"
apt-config dump | grep -E '^Acquire::https?::Proxy' >"$system/etc/apt/apt.conf.d/proxy" || true
echo force-unsafe-io >"$system/etc/dpkg/dpkg.cfg.d/speed"  # a system that does not outlive a power failure need not be on the disk

# Git refuses the repository of another user, as the checkout is under sudo, unless its configuration names it.
HOME="$scratch" git config --global safe.directory '*'
HOME="$scratch" git clone --quiet "$root" "$system/root/freevoxels"

# In namespaces of its own, so that the mounts and all processes end with the shell.
inside() {
  unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$0/proc"
    mount -t tmpfs tmpfs "$0/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=0666 devpts "$0/dev/pts"
    exec chroot "$0" env -i "$@"' \
    "$system" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-2}" "$@"
}

for command in apps/demo.sh tests/run.sh; do
  echo "debian: on $suite: bash $command"
  inside bash "/root/freevoxels/$command" || fail "on $suite, 'bash $command' failed"
done
for image in cloud.exr cloud.png; do
  [ -s "$system/root/freevoxels/out/$image" ] || fail "on $suite, 'bash apps/demo.sh' made no out/$image"
done
echo "debian: both commands PASSED on $suite"
