"""Checks tags, sizes, libraries and licences of wheels, and what is in the source distribution. Usage: wheel_contents.py FOLDER"""

import pathlib
import re
import struct
import sys
import tarfile
import zipfile

MEGABYTES = {"freevoxels": 16, "freevoxels_lavapipe": 65}
OF_EVERY_LINUX = re.compile(r"(?:ld-linux-x86-64|lib(?:c|m|dl|rt|pthread|stdc\+\+|gcc_s|z|expat))\.so\.\d+")
LICENSE_OF_PACKAGE = re.compile(r"\.dist-info/licenses/[^/]+/copyright$")


def needed(elf):
    """The names of the shared libraries that a 64-bit little-endian ELF file asks for."""
    sections, = struct.unpack_from("<Q", elf, 0x28)
    size, count = struct.unpack_from("<HH", elf, 0x3A)
    headers = [struct.unpack_from("<IIQQQQIIQQ", elf, sections + k * size) for k in range(count)]
    for _, kind, _, _, offset, length, link, *_ in headers:
        if kind != 6:  # SHT_DYNAMIC
            continue
        names = headers[link][4]
        for tag, value in struct.iter_unpack("<QQ", elf[offset:offset + length]):
            if tag == 1:  # DT_NEEDED
                start = names + value
                yield elf[start:elf.index(b"\0", start)].decode()


def problems_of(wheel):
    name, _, *_, tag = wheel.stem.split("-")
    size = wheel.stat().st_size / 1e6
    print(f"{wheel.name}: {size:.1f} MB")
    if size > MEGABYTES[name]:
        yield f"is larger than {MEGABYTES[name]} MB"
    versions = [int(minor) for minor in re.findall(r"manylinux_2_(\d+)_", tag)]
    if not versions or name == "freevoxels" and min(versions) > 35:
        yield f"has the tag {tag}"
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        elves = {file: archive.read(file) for file in names if archive.open(file).read(4) == b"\x7fELF"}
        if not any(file.endswith(".dist-info/licenses/LICENSE") for file in names):
            yield "lacks its own licence"
    inside = {file.split("/")[-1] for file in elves}
    for file, content in elves.items():
        for library in needed(content):
            if library not in inside and not OF_EVERY_LINUX.fullmatch(library):
                yield f"lacks {library}, which {file} needs"
    grafted = [file for file in elves if ".libs/" in file]
    licences = [file for file in names if LICENSE_OF_PACKAGE.search(file)]
    print(f"    {len(grafted)} libraries of Debian, licences of {len(licences)} packages")
    if not grafted or not licences:
        yield "has no libraries of Debian, or no licences"


def missing_of(source):
    with tarfile.open(source) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    print(f"{source.name}: {len(names)} files")
    for name in ("PKG-INFO", "pyproject.toml", "CMakeLists.txt", "LICENSE", "engine/renderer.cpp", "shaders/gather.comp",
                 "apps/python/setup.py"):
        if name not in names:
            yield f"lacks {name}"
    if any(name.startswith("build/") for name in names):
        yield "has files of a build"


def main(folder):
    wheels, sources = sorted(folder.glob("*.whl")), sorted(folder.glob("*.tar.gz"))
    found = [f"{wheel.name} {problem}" for wheel in wheels for problem in problems_of(wheel)]
    found += [f"{source.name} {problem}" for source in sources for problem in missing_of(source)]
    if len(wheels) != 2 or len(sources) != 1:
        found.append(f"{folder} has {len(wheels)} wheels and {len(sources)} source distributions instead of 2 and 1")
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
