#!/usr/bin/env bash
# Makes a container image of a bare Debian with FreeVoxels' packages in it, as an OCI archive that Podman, Docker and Apptainer load.
#   bash apps/container/build.sh OUT.tar [PACKAGE.deb...]     without packages: the one that cpack makes here, built first if need be
# Needs mmdebstrap, buildah, uidmap and a network, and no root. MIRROR=URL names the Debian mirror; otherwise it is Debian's own.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"

fail() {
  echo "container: $*" >&2
  exit 1
}

[ $# -ge 1 ] || fail "name the image: bash apps/container/build.sh freevoxels.tar"
out="$(realpath "$1")"
shift
for tool in mmdebstrap buildah newuidmap; do
  command -v "$tool" >/dev/null || fail "$tool is missing: apt-get install mmdebstrap buildah uidmap"
done
if [ $# -eq 0 ]; then
  bash "$root/apps/setup.sh" all
  rm -f "$root"/build/packages/*.deb # of another version
  cpack --config "$root/build/CPackConfig.cmake" -B "$root/build/packages"
  set -- "$root"/build/packages/freevoxels_*.deb
fi

# The packages depend on the Debian that they were made on, which their version names.
version="$(dpkg-deb -f "$1" Version)"
case "$version" in
  *+debian12) suite=bookworm ;;
  *+debian13) suite=trixie ;;
  *) fail "$1 is a package for none of Debian 12 and 13: its version is $version" ;;
esac

scratch="$(mktemp -d)"
container=""
cleanup() {
  [ -z "$container" ] || buildah rm "$container" >/dev/null
  rm -rf "$scratch"
}
trap cleanup EXIT
trap 'exit 130' INT TERM HUP

# Only what runs: of recommended packages NumPy alone, of documentation the licences alone. NVIDIA's driver needs libXext. A system that
# is made with merged folders needs no Perl to merge them.
mkdir "$scratch/packages"
cp "$@" "$scratch/packages"
chmod -R a+rX "$scratch"
echo "container: making a bare $suite with $*"
mmdebstrap --variant=minbase --hook-dir=/usr/share/mmdebstrap/hooks/maybe-merged-usr --include=usr-is-merged \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright' \
  --dpkgopt='path-include=/usr/share/doc/freevoxels/third_party_notes/*' \
  --dpkgopt='path-exclude=/usr/share/locale/*' --dpkgopt='path-exclude=/usr/share/lintian/*' \
  --customize-hook="copy-in '$scratch/packages' /" \
  --customize-hook='chroot "$1" sh -ec "apt-get install -y -qq --no-install-recommends /packages/*.deb python3-numpy libxext6; rm -r /packages"' \
  "$suite" "$scratch/system.tar" ${MIRROR:+"$MIRROR"}

container="$(buildah from scratch)"
buildah add --quiet "$container" "$scratch/system.tar" / >/dev/null
# NVIDIA's container toolkit gives a container the Vulkan driver of its host if these variables ask for it.
buildah config --entrypoint '["freevoxels"]' --cmd --help --workingdir /work --env LANG=C.UTF-8 \
  --env NVIDIA_VISIBLE_DEVICES=all --env NVIDIA_DRIVER_CAPABILITIES=graphics,display,utility \
  --label org.opencontainers.image.title=FreeVoxels --label org.opencontainers.image.version="$version" \
  --label org.opencontainers.image.licenses=Apache-2.0 "$container"
rm -f "$out"
buildah commit --quiet --rm --disable-compression=false "$container" "oci-archive:$out:freevoxels:latest" >/dev/null
container=""
echo "container: $out, $(du -m "$out" | cut -f 1) MiB"
