"""The command `freevoxels` of wheels: the compiled program, which lies in the package freevoxels.

Beside the package instead of in it, so that the command imports neither NumPy nor the compiled module."""

import os
import pathlib
import runpy
import sys

PACKAGE = pathlib.Path(__file__).with_name("freevoxels")


def main():
    loader = runpy.run_path(str(PACKAGE / "_cpu_driver.py"))["offer"]()
    if loader is not None:
        folders = [os.environ.get("LD_LIBRARY_PATH"), str(loader.parent)]
        os.environ["LD_LIBRARY_PATH"] = ":".join(folder for folder in folders if folder)
    os.execv(PACKAGE / "program" / "freevoxels", ["freevoxels", *sys.argv[1:]])
