"""Builds the module with CMake, for `pip install`: apps/manual/python.md."""

import os
import re
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "pip"  # ignored by git, as all of build/


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        folder = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DBUILD_TESTING=OFF", f"-DPython_EXECUTABLE={sys.executable}",
             f"-DFREEVOXELS_PYTHON_FOLDER={folder}"], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "freevoxels_python"], check=True)


BUILD.mkdir(parents=True, exist_ok=True)
os.chdir(Path(__file__).resolve().parent)
setup(
    name="freevoxels",
    version=re.search(r"project\(FreeVoxels VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
    description="Renders volumes with shadows, on a GPU or on the CPU",
    license="Apache-2.0",
    python_requires=">=3.9",
    install_requires=["numpy"],
    py_modules=[],
    ext_modules=[Extension("freevoxels", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"build": {"build_base": str(BUILD / "setuptools")}, "egg_info": {"egg_base": str(BUILD)}},
)
