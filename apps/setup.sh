#!/usr/bin/env bash
# Installs the Debian packages that are missing and builds. Does nothing twice.
#   bash apps/setup.sh [CMAKE TARGET...]     default target: freevoxels
# FREEVOXELS_PRESET names another preset that builds in build/.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

# The one list of what FreeVoxels needs of Debian 12 and 13; third_party_notes/README.md says why. Of "a|b", names of one package in
# different releases, it takes the first that is installed or else exists.
packages=(
  g++ cmake ninja-build pkg-config
  libvulkan-dev libvulkan-volk-dev mesa-vulkan-drivers vulkan-validationlayers
  glslang-tools spirv-tools
  libglm-dev libfmt-dev libspdlog-dev nlohmann-json3-dev libcli11-dev
  libopenexr-dev libpng-dev libjpeg62-turbo-dev
  libglfw3-dev libimgui-dev fonts-dejavu-core libstb-dev
  libopenvdb-dev libtbb-dev libboost-iostreams-dev # OpenVDB's headers and CMake module need the last
  liblog4cplus-dev # turns the messages of OpenVDB off
  libxxhash-dev libzstd-dev libblosc-dev zlib1g-dev
  libpugixml-dev # scans, and transfer functions of other programs
  libinsighttoolkit5-dev libtiff-dev # scans
  pybind11-dev python3-pybind11 python3-dev python3-numpy # the Python module
  help2man man-db # man pages, and their test
  libgtest-dev xvfb xdotool python3-openvdb
)
# Only freevoxels-mpi, and so all, needs Open MPI, which brings 38 packages; the fuzzers alone need Clang.
for target in "$@"; do
  case $target in freevoxels-mpi | all) packages+=(libopenmpi-dev) ;; esac
  case $target in all) packages+=(clang 'libclang-rt-dev|libclang-rt-14-dev') ;; esac
done

say() { echo "setup: $*"; }

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# first TEST NAME|NAME...: the first name that passes the test.
first() {
  local name
  for name in ${2//|/ }; do
    if "$1" "$name"; then
      echo "$name"
      return
    fi
  done
  return 1
}

exists() { [ -n "$(apt-cache madison "$1" 2>/dev/null)" ]; }

install_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "this script installs Debian packages, and this system has no apt-get."
    say "Install what these Debian packages hold, then run: cmake --preset release && cmake --build --preset release"
    say "  ${packages[*]%%|*}"
    exit 1
  fi
  local missing=() package
  for package in "${packages[@]}"; do
    first installed "$package" >/dev/null || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    say "all Debian packages are there"
    return
  fi

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      say "as root, please run: apt-get install ${missing[*]%%|*}"
      exit 1
    fi
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  local found=()
  for package in "${missing[@]}"; do
    found+=("$(first exists "$package")") || {
      say "apt-get knows no package ${package//|/ or }: FreeVoxels is built with the packages of Debian 12 or 13"
      exit 1
    }
  done
  say "installing with apt-get: ${found[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o DPkg::Lock::Timeout=120 "${found[@]}"
  installed_packages=1
}

build() {
  cd "$root"
  # Again where packages are new: without Open MPI there is no target freevoxels-mpi.
  [ -f build/build.ninja ] && [ -z "${installed_packages:-}" ] || cmake --preset "${FREEVOXELS_PRESET:-release}"
  cmake --build --preset release --target "$@"
}

install_packages
say "building in $root/build"
build "${@:-freevoxels}"
