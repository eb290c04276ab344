"""Writes the wheel freevoxels-lavapipe: this system's Vulkan driver for the CPU, Mesa's lavapipe, and its Vulkan loader.

    lavapipe_wheel.py VERSION FOLDER

The libraries that the driver needs, such as LLVM, are added by auditwheel, but for those that its policies expect of every system."""

import json
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile

import wheel_archive
from system_libraries import lavapipe_file, lavapipe_manifest, library_file

ALSO = ("libexpat.so.1", "libz.so.1")  # which slim images of Python may lack, although auditwheel expects them
TAG = f"py3-none-linux_{platform.machine()}"
MODULE = '"""Mesa\'s lavapipe and a Vulkan loader, which the package freevoxels uses where the system has no driver for the CPU."""\n'


def metadata(version):
    return (f"Metadata-Version: 2.1\nName: freevoxels-lavapipe\nVersion: {version}\n"
            "Summary: Vulkan on the CPU for freevoxels: Mesa's lavapipe, LLVM and the Vulkan loader\n"
            "License: MIT and Apache-2.0 and others, see the folder licenses\nRequires-Python: >=3.9\n")


def looking_beside_itself(library):
    """The content of a shared library that looks for others in its own folder first."""
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copy(library, folder)
        subprocess.run(["patchelf", "--set-rpath", "$ORIGIN", copy], check=True)
        return pathlib.Path(copy).read_bytes()


def main(version, folder):
    driver = lavapipe_manifest()
    driver["ICD"]["library_path"] = "./libvulkan_lvp.so"  # beside the manifest
    package, about = "freevoxels_lavapipe", f"freevoxels_lavapipe-{version}.dist-info"
    texts = {
        f"{package}/__init__.py": MODULE,
        f"{package}/lvp_icd.json": json.dumps(driver, indent=4) + "\n",
        f"{about}/METADATA": metadata(version),
        f"{about}/WHEEL": f"Wheel-Version: 1.0\nGenerator: freevoxels\nRoot-Is-Purelib: false\nTag: {TAG}\n",
        f"{about}/top_level.txt": f"{package}\n",
    }
    files = {name: (text.encode(), wheel_archive.DATA) for name, text in texts.items()}
    files[f"{package}/libvulkan_lvp.so"] = (looking_beside_itself(lavapipe_file()), wheel_archive.PROGRAM)
    for name in ("libvulkan.so.1", *ALSO):
        files[f"{package}/{name}"] = (library_file(name).read_bytes(), wheel_archive.PROGRAM)
    wheel_archive.write(pathlib.Path(folder) / f"{package}-{version}-{TAG}.whl", files)


main(*sys.argv[1:])
