"""The command `freevoxels` of wheels: the compiled program, which lies in this package."""

import os
import pathlib
import sys

from freevoxels import _cpu_driver


def main():
    loader = _cpu_driver.offer()
    if loader is not None:
        folders = [os.environ.get("LD_LIBRARY_PATH"), str(loader.parent)]
        os.environ["LD_LIBRARY_PATH"] = ":".join(folder for folder in folders if folder)
    program = pathlib.Path(__file__).with_name("program") / "freevoxels"
    os.execv(program, ["freevoxels", *sys.argv[1:]])
