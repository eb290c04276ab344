"""Runs tests of the module under NumPy 2, in a virtual environment. Usage: numpy_2_test.py FOLDER TEST.py...

The environment is made in FOLDER by this Python, for which the module is built. Exits with 77 where NumPy 2 cannot be installed."""

import pathlib
import subprocess
import sys

SKIPPED = 77


def environment(folder):
    """The Python of the environment, or None."""
    python = folder / "bin" / "python"
    check = [python, "-c", "import numpy, sys; sys.exit(not numpy.__version__.startswith('2.'))"]
    if python.exists() and subprocess.run(check, stderr=subprocess.DEVNULL).returncode == 0:
        return python
    for command in ([sys.executable, "-m", "venv", "--clear", folder], [python, "-m", "pip", "install", "--quiet", "numpy>=2,<3"]):
        made = subprocess.run(command, capture_output=True, text=True)
        if made.returncode != 0:
            last = (made.stderr or made.stdout).strip().splitlines()[-1:]
            print(f"skipped: there is no NumPy 2 here, and it cannot be installed (no network, or no package python3-venv): {' '.join(last)}")
            return None
    return python


def main():
    python = environment(pathlib.Path(sys.argv[1]))
    if python is None:
        return SKIPPED
    print(subprocess.run([python, "-c", "import numpy, freevoxels; print('NumPy', numpy.__version__, 'with', freevoxels.__file__)"],
                         capture_output=True, text=True).stdout, flush=True)
    return max(subprocess.run([python, "-W", "error::DeprecationWarning", test]).returncode for test in sys.argv[2:])


sys.exit(main())
