#!/usr/bin/env bash
# Builds the wheels and the source distribution, and tries them as a user does: in empty environments with NumPy 1.26 and NumPy 2, where the
# system's Vulkan, Mesa and LLVM are masked, both front ends draw the image of the program in build/bin, bit for bit.
#   bash tests/wheels.sh [FOLDER]     a folder that apps/python/wheels.sh made; without it they are built
# Needs what apps/python/wheels.sh needs, build/bin/freevoxels, and root or user namespaces, for the masks. PYTHON=FILE makes the environments, a
# Python of the version that the wheels are for. SDIST=0 leaves the source distribution out, which is built as long as the programs.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
python="${PYTHON:-/usr/bin/python3}"
program="$root/build/bin/freevoxels"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

fail() {
  echo "wheels: $*" >&2
  exit 1
}

[ -x "$program" ] || fail "there is no $program, whose image is the one to draw: bash apps/setup.sh"
if [ $# -eq 0 ]; then
  bash "$root/apps/python/wheels.sh" "$scratch/wheels"
  set -- "$scratch/wheels"
fi
wheels="$(cd "$1" && pwd)"
"$python" "$root/tests/python/wheel_contents.py" "$wheels" || fail "the wheels are not what they should be"

namespaces=(unshare --mount)
[ "$(id -u)" -eq 0 ] || namespaces+=(--map-root-user)

# masked COMMAND...: runs it where the system has no Vulkan loader, no drivers and no LLVM, and the user has named no drivers.
masked() {
  # shellcheck disable=SC2016
  "${namespaces[@]}" env -u VK_ADD_DRIVER_FILES -u VK_DRIVER_FILES -u VK_ICD_FILENAMES -u PYTHONPATH bash -euc '
    : >"$0/empty"
    mkdir -p "$0/nothing"
    for file in /usr/lib/*/libvulkan* /usr/lib/*/libLLVM* /usr/lib/llvm-*/lib/libLLVM* /usr/local/lib/libvulkan*; do
      if [ -f "$file" ] && [ ! -L "$file" ]; then mount --bind "$0/empty" "$file"; fi
    done
    for folder in /usr/share/vulkan /usr/local/share/vulkan /etc/vulkan; do
      if [ -d "$folder" ]; then mount --bind "$0/nothing" "$folder"; fi
    done
    exec "$@"' "$scratch" "$@"
}

cd "$scratch"
"$program" generate cloud cloud.vdb --resolution 48
scene=(cloud.vdb --size 320x240 --transfer-function "$root/apps/transfer_functions/cloud.json" --orbit 30,20)
"$program" render "${scene[@]}" expected.png --quiet
cat >draw.py <<END
import os, sys
import freevoxels

image = freevoxels.render("cloud.vdb", size=(320, 240), transfer_function="$root/apps/transfer_functions/cloud.json", orbit=(30, 20))
assert image.shape == (240, 320, 4) and 0.5 < image[:, :, 3].max() <= 1 and image[:, :, :3].std() > 0.05, "the image is empty"
freevoxels.save("python.png", image)
# What is open of the system, apart from Python and what every Linux has.
common = r"(?:ld-linux|lib(?:c|m|dl|rt|util|pthread|stdc\+\+|gcc_s|python|crypt|crypto|ssl|ffi|uuid|nsl|mvec|bz2|lzma|z|expat|sqlite3))[-.\d]"
import re
opened = {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line.split()[-1]}
own = (os.path.realpath(sys.prefix), os.path.realpath(sys.base_prefix) + "/lib/python", "/usr/lib/python3")
foreign = sorted(file for file in opened if not file.startswith(own) and not re.match(common, os.path.basename(file)))
assert not foreign, f"the wheel uses libraries of the system: {foreign}"
END

for numpy in 'numpy==1.26.*' 'numpy>=2,<3'; do
  echo "wheels: with $numpy"
  rm -rf venv python.png command.png
  "$python" -m venv venv || fail "a virtual environment cannot be made: apt-get install python3-venv"
  venv/bin/pip install --quiet "$numpy" || fail "$numpy cannot be installed"
  venv/bin/pip install --quiet --no-index --find-links "$wheels" 'freevoxels[cpu]'
  masked venv/bin/python draw.py
  masked venv/bin/freevoxels render "${scene[@]}" command.png --quiet
  for image in python.png command.png; do cmp "$image" expected.png || fail "$image differs from that of the program"; done
  masked venv/bin/freevoxels devices | grep llvmpipe >devices.txt || fail "the command lists no driver for the CPU"
  # The user's choice of drivers stays, also where it is a bad one.
  if masked env VK_DRIVER_FILES=/nowhere.json venv/bin/python draw.py 2>no_driver.txt; then
    fail "a driver was used although VK_DRIVER_FILES names another"
  fi
  grep -q 'freevoxels.DeviceError: no Vulkan' no_driver.txt || { cat no_driver.txt >&2; fail "VK_DRIVER_FILES was not heeded"; }
done

echo "wheels: types, and the driver of the system"
venv/bin/pip install --quiet mypy || fail "mypy cannot be installed"
venv/bin/python -m mypy --strict "$root/tests/python/typed_script.py"
masked venv/bin/python "$root/tests/python/typed_script.py"
if [ -e "/usr/share/vulkan/icd.d/lvp_icd.$(uname -m).json" ]; then
  env -u VK_ADD_DRIVER_FILES -u VK_DRIVER_FILES -u VK_ICD_FILENAMES venv/bin/python -c \
    'import os, freevoxels; assert "VK_ADD_DRIVER_FILES" not in os.environ' || fail "the driver of the wheel was offered beside that of the system"
fi

if [ "${SDIST:-1}" != 0 ]; then
  echo "wheels: building the source distribution, offline"
  rm -rf venv
  /usr/bin/python3 -m venv --system-site-packages venv
  venv/bin/pip install --quiet --no-build-isolation --no-index "$wheels"/freevoxels-*.tar.gz ||
    fail "the source distribution cannot be installed; it needs apt-get install python3-pip python3-setuptools python3-wheel"
  rm -f command.png
  venv/bin/freevoxels render "${scene[@]}" command.png --quiet
  cmp command.png expected.png
  venv/bin/python -c 'import freevoxels; print("freevoxels", freevoxels.__version__, "of the source distribution")'
fi
cp expected.png "$wheels/cloud.png"
echo "wheels: PASSED, the image is $wheels/cloud.png"
