#!/usr/bin/env bash
# Makes a bare Debian system, runs both commands of the README in a clone of what is committed here, makes the Debian packages there and
# tries them in a second bare system, and takes both away again.
#   sudo bash tests/debian.sh SUITE      bookworm or trixie; needs debootstrap, a network, 10 GB in $TMPDIR or /tmp, and 40 minutes
# MIRROR=URL names the Debian mirror; otherwise it is the one that this machine's apt has.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$root/tests/bare_debian.sh"

[ $# -eq 1 ] || fail "name one suite: bookworm or trixie"
suite="$1"

scratch="$(mktemp -d)"
trap 'rm -rf --one-file-system "$scratch"' EXIT
trap 'exit 130' INT TERM HUP
system="$scratch/$suite"
make_system "$suite" "$system"

# Git refuses the repository of another user, as the checkout is under sudo, unless its configuration names it.
HOME="$scratch" git config --global safe.directory '*'
HOME="$scratch" git clone --quiet "$root" "$system/root/freevoxels"

for command in apps/demo.sh tests/run.sh; do
  echo "debian: on $suite: bash $command"
  inside "$system" bash "/root/freevoxels/$command" || fail "on $suite, 'bash $command' failed"
done
for image in cloud.exr cloud.png; do
  [ -s "$system/root/freevoxels/out/$image" ] || fail "on $suite, 'bash apps/demo.sh' made no out/$image"
done
echo "debian: both commands PASSED on $suite"

echo "debian: on $suite: cpack"
inside "$system" apt-get install -y -qq --no-install-recommends dpkg-dev file >/dev/null
inside "$system" bash -c 'cd /root/freevoxels && cpack --config build/CPackConfig.cmake -B build/packages' ||
  fail "on $suite, cpack failed"
bash "$root/tests/debian_packages.sh" "$suite" "$system"/root/freevoxels/build/packages/*.deb
