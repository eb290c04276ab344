"""Runs tests of the module under NumPy 2, in a virtual environment, and has mypy check a user's script there.

Usage: numpy_2_test.py FOLDER TYPED_SCRIPT.py TEST.py...

The environment is made in FOLDER by this Python, for which the module is built, and PYTHONPATH is where. Exits with 77 where NumPy 2 or mypy
cannot be installed."""

import os
import pathlib
import subprocess
import sys

SKIPPED = 77


def environment(folder):
    """The Python of the environment, or None."""
    python = folder / "bin" / "python"
    check = [python, "-c", "import mypy, numpy, sys; sys.exit(not numpy.__version__.startswith('2.'))"]
    if python.exists() and subprocess.run(check, stderr=subprocess.DEVNULL).returncode == 0:
        return python
    for command in ([sys.executable, "-m", "venv", "--clear", folder], [python, "-m", "pip", "install", "--quiet", "--no-compile", "numpy>=2,<3", "mypy"]):
        made = subprocess.run(command, capture_output=True, text=True)
        if made.returncode != 0:
            last = (made.stderr or made.stdout).strip().splitlines()[-1:]
            print(f"skipped: there is no NumPy 2 or mypy here, and they cannot be installed (no network, or no package python3-venv): {' '.join(last)}")
            return None
    return python


def accepted_by_mypy(python, script):
    """Whether the types that the package has once it is installed make sense of a script."""
    (packages,) = python.parents[1].glob("lib/python*/site-packages")
    (packages / "freevoxels.pth").write_text(os.environ["PYTHONPATH"] + "\n")  # mypy does not look at PYTHONPATH
    cache = python.parents[1] / "mypy_cache"
    return subprocess.run([python, "-m", "mypy", "--strict", "--cache-dir", cache, script]).returncode == 0


def main():
    python = environment(pathlib.Path(sys.argv[1]))
    if python is None:
        return SKIPPED
    # The same tests are run with the validation layers elsewhere. What is imported is compiled once, and nothing else.
    os.environ.pop("FREEVOXELS_VALIDATION", None)
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    os.environ["PYTHONPYCACHEPREFIX"] = str(pathlib.Path(sys.argv[1]) / "compiled")
    print(subprocess.run([python, "-c", "import numpy, freevoxels; print('NumPy', numpy.__version__, 'with', freevoxels.__file__)"],
                         capture_output=True, text=True).stdout, flush=True)
    failed = [test for test in sys.argv[2:] if subprocess.run([python, "-W", "error::DeprecationWarning", test]).returncode != 0]
    return 1 if failed or not accepted_by_mypy(python, sys.argv[2]) else 0


sys.exit(main())
