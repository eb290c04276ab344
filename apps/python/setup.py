"""Builds the package with CMake, for `pip install`, and the source distribution: apps/manual/python.md."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.sdist import sdist

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "pip"  # ignored by git, as all of build/
VERSION = re.search(r"project\(FreeVoxels VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


class CMakeBuild(build_ext):
    """The compiled module, the program that the command `freevoxels` runs, and the engine that both share, stripped."""

    def build_extension(self, extension):
        package = Path(self.get_ext_fullpath(extension.name)).resolve().parent
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DBUILD_TESTING=OFF", "-DCMAKE_UNITY_BUILD=ON",
             "-DFREEVOXELS_SHARED_ENGINE=ON", "-DCMAKE_BUILD_WITH_INSTALL_RPATH=ON", "-DCMAKE_INSTALL_RPATH=$ORIGIN;$ORIGIN/..",
             *(f"-DCMAKE_{kind}_LINKER_FLAGS=-s" for kind in ("EXE", "MODULE", "SHARED")), f"-DPython_EXECUTABLE={sys.executable}",
             f"-DFREEVOXELS_PYTHON_FOLDER={package.parent}"], check=True)
        subprocess.run(["cmake", "--build", BUILD, "--target", "freevoxels_python", "freevoxels"], check=True)
        shutil.copy2(BUILD / "engine" / "libfreevoxels_engine.so", package)
        (package / "program").mkdir(exist_ok=True)
        shutil.copy2(BUILD / "bin" / "freevoxels", package / "program" / "freevoxels")


class SourceTree(sdist):
    """The files that git tracks, or where there is no git those of the source distribution, with its description."""

    def make_release_tree(self, base_dir, files):
        for file in sources():
            copy = Path(base_dir) / file
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / file, copy)
        project = (ROOT / "apps" / "python" / "pyproject.toml").read_text()
        (Path(base_dir) / "pyproject.toml").write_text(project.replace('backend-path = ["."]', 'backend-path = ["apps/python"]'))
        self.distribution.metadata.write_pkg_info(base_dir)

    def check_readme(self):
        """setuptools looks for the README in this folder, but it is in the root."""


def sources():
    if (ROOT / ".git").exists():
        tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
        return [file for file in tracked.split("\0") if file and (ROOT / file).exists()]
    return [file.relative_to(ROOT) for file in ROOT.rglob("*")
            if file.is_file() and "__pycache__" not in file.parts and not re.match(r"build|out$", file.relative_to(ROOT).parts[0])]


def shared(folder):
    """Files of the folder of that name beside this one, where `cmake --install` has them, too: below share/freevoxels."""
    return (f"share/freevoxels/{folder}", [str(file) for file in sorted(Path("..", folder).iterdir()) if file.is_file()])


BUILD.mkdir(parents=True, exist_ok=True)
os.chdir(Path(__file__).resolve().parent)
setup(
    name="freevoxels",
    version=VERSION,
    description="Renders volumes with shadows, on a GPU or on the CPU",
    license="Apache-2.0",
    python_requires=">=3.9",
    install_requires=["numpy"],
    extras_require={"cpu": [f"freevoxels-lavapipe=={VERSION}"]},
    packages=["freevoxels"],
    py_modules=["freevoxels_program"],
    package_data={"freevoxels": ["py.typed", "*.pyi"]},
    data_files=[shared("scenes"), shared("transfer_functions")],
    entry_points={"console_scripts": ["freevoxels = freevoxels_program:main"]},
    ext_modules=[Extension("freevoxels._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild, "sdist": SourceTree},
    options={"build": {"build_base": str(BUILD / "setuptools")}, "egg_info": {"egg_base": str(BUILD)}},
)
