"""Where this Debian system has a shared library, and of which package it is."""

import functools
import json
import pathlib
import platform
import re
import subprocess
import sys


def output(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


@functools.cache
def known_libraries():
    """Files by the name that programs ask for, and by their own, which may have more of the version: libz.so.1 and libz.so.1.2.13."""
    found = {}
    for name, kind, file in re.findall(r"^\t(\S+) \(([^)]*)\) => (\S+)$", output("/sbin/ldconfig", "-p"), re.MULTILINE):
        if platform.machine().replace("_", "-") in kind:
            found.setdefault(name, file)
            found.setdefault(pathlib.Path(file).resolve().name, file)
    return found


def library_file(name):
    """The file of a library, given by its path, or by a name that the dynamic linker finds."""
    if "/" not in name and name not in known_libraries():
        sys.exit(f"this system has no {name}")
    return pathlib.Path(name if "/" in name else known_libraries()[name]).resolve()


def lavapipe_manifest():
    """What Vulkan's loader reads of the driver for the CPU, whose library is not among those that the dynamic linker finds by name."""
    for name in (f"lvp_icd.{platform.machine()}.json", "lvp_icd.json"):
        if (file := pathlib.Path("/usr/share/vulkan/icd.d") / name).exists():
            return json.loads(file.read_text())
    sys.exit("this system has no Vulkan driver for the CPU: apt-get install mesa-vulkan-drivers")


def lavapipe_file():
    return library_file(lavapipe_manifest()["ICD"]["library_path"])


def package_of(file):
    """The Debian package that a file is of."""
    # Packages that were made before /lib became a link to /usr/lib list their files there.
    for name in (file, pathlib.Path(str(file).removeprefix("/usr"))):
        found = subprocess.run(["dpkg-query", "--search", name], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    sys.exit(f"{file} is of no Debian package, so that its licence is not known")


def version_of(package):
    """(version, source package, version of the source package)"""
    form = "${Version}\t${source:Package}\t${source:Version}\n"
    return output("dpkg-query", "--show", "--showformat", form, package).splitlines()[0].split("\t")


def copyright_of(package):
    file = pathlib.Path("/usr/share/doc") / package / "copyright"
    if not file.exists():
        sys.exit(f"{file}, the licence of what goes into the wheel, is missing: reinstall {package}")
    return file.read_bytes()
