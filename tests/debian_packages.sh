#!/usr/bin/env bash
# Installs packages that cpack made in a bare Debian system, tries what they install, removes them, and asks lintian about them.
#   sudo bash tests/debian_packages.sh SUITE PACKAGE.deb...     bookworm or trixie; needs debootstrap, a network and 2 GB in $TMPDIR or /tmp
# The packages are freevoxels and, for its part of the test, freevoxels-mpi.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
. "$root/tests/bare_debian.sh"

[ $# -ge 2 ] || fail "name a suite and the packages: sudo bash tests/debian_packages.sh bookworm build/packages/*.deb"
suite="$1"
shift

scratch="$(mktemp -d)"
trap 'rm -rf --one-file-system "$scratch"' EXIT
trap 'exit 130' INT TERM HUP
system="$scratch/$suite"
make_system "$suite" "$system"
mkdir "$system/root/packages" "$system/root/tried"
cp "$@" "$system/root/packages"
packages=()
for package in "$@"; do packages+=("$(dpkg-deb -f "$package" Package)"); done

# try COMMAND: in the system, in a folder that is its home as well, so that all that it writes is there.
try() {
  echo "debian: on $suite: $1"
  inside "$system" HOME=/root/tried bash -euo pipefail -c "cd /root/tried; $1" || fail "on $suite, '$1' failed"
}

install() { try "apt-get install -y -qq --no-install-recommends $* >../apt.log 2>&1 || { tail ../apt.log; exit 1; }"; }

try 'apt-get update -qq'
install man-db
# Documentation and man pages are as Debian installs them by default; nothing may be left out of a package that is tried.
install '../packages/freevoxels_*.deb'
try 'freevoxels render procedural:cloud cloud.png'
try 'freevoxels info procedural:cloud'
try 'python3 -c "import freevoxels; print(freevoxels.__version__)"'
try 'man freevoxels-render | grep -e --orbit >/dev/null'
try 'freevoxels-view --help >/dev/null'
try 'freevoxels-bench --version && freevoxels-validate --version'
install python3-numpy
try "python3 -c 'import freevoxels; freevoxels.save(\"python.png\", freevoxels.render(\"procedural:cloud\"))' && cmp python.png cloud.png"
if [[ " ${packages[*]} " == *" freevoxels-mpi "* ]]; then
  install '../packages/freevoxels-mpi_*.deb'
  try 'mpirun --allow-run-as-root --oversubscribe -n 2 freevoxels-mpi render procedural:cloud two.png --size 200x150'
  try 'freevoxels render procedural:cloud one.png --size 200x150 --share 0/1 && cmp one.png two.png'
  try 'man freevoxels-mpi-render | grep -e --orbit >/dev/null'
fi
install g++ cmake make libvulkan-dev
for example in minimal interop; do
  try "cmake -S /usr/share/doc/freevoxels/apps/examples/$example -B $example >log && cmake --build $example >log && cd $example && ./$example"
done

try "dpkg -L ${packages[*]} >../files && apt-get purge -y -qq ${packages[*]} >../apt.log"
try 'while read -r file; do [ -d "$file" ] || [ ! -e "$file" ] || { echo "$file is left"; exit 1; }; done <../files'
# Formatted pages are man's, which drops them once a week.
try '! find / -xdev -iname "*freevoxels*" -not -path "/root/*" -not -path "/var/cache/man/*" | grep .'

install lintian
try 'lintian --fail-on error,warning ../packages/*.deb'
echo "debian: the packages PASSED on $suite"
