"""Adds to a wheel that auditwheel repaired the licences of the Debian packages whose parts are in it, and compresses it as far as it goes.

    finish_wheel.py WHEEL FOLDER LICENSE [HEADER...]

LICENSE is the file of the wheel's own licence. The packages of shared libraries are found by their names; each HEADER is a file of a package
whose headers are compiled in."""

import pathlib
import re
import sys

import wheel_archive
from system_libraries import copyright_of, lavapipe_file, library_file, package_of, version_of

# auditwheel puts a checksum into the name of a library: libfoo-0a1b2c3d.so.1.
CHECKSUM = re.compile(r"-[0-9a-f]{8}(?=\.)")
INTRODUCTION = """Parts of these Debian packages are in this wheel, unchanged but for the places where shared libraries look for each other.
The files beside this one are their copyright files. `apt-get source SOURCE=VERSION` of Debian gives the source code.

"""


def libraries(files):
    """The names that the system has for the shared libraries of others in a wheel."""
    names = {name.split("/")[-1] for name in files if ".so" in name and not name.startswith("freevoxels/")}
    return {CHECKSUM.sub("", name) for name in names}


def file_of(library):
    return lavapipe_file() if library == "libvulkan_lvp.so" else library_file(library)


def main(wheel, folder, own_license, *headers):
    files = wheel_archive.read(wheel)
    about = wheel_archive.description_folder(files)
    packages = {package_of(file) for file in [*map(file_of, libraries(files)), *map(pathlib.Path, headers)]}
    notice, folders = INTRODUCTION, {}
    for package in sorted(packages):
        version, source, source_version = version_of(package)
        license_text = copyright_of(package)
        name = folders.setdefault(license_text, package)
        notice += f"{package} {version}, of the source package {source}={source_version}: {name}/copyright\n"
        files[f"{about}/licenses/{name}/copyright"] = (license_text, wheel_archive.DATA)
    files[f"{about}/licenses/PACKAGES"] = (notice.encode(), wheel_archive.DATA)
    files[f"{about}/licenses/LICENSE"] = (pathlib.Path(own_license).read_bytes(), wheel_archive.DATA)
    wheel_archive.write(pathlib.Path(folder) / pathlib.Path(wheel).name, files)


main(*sys.argv[1:])
