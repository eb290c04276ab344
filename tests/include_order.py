#!/usr/bin/env python3
"""Checks that data flows one way through the folders: no file includes a header of a folder that comes later, and no program one of another
program.

    include_order.py PROJECT_FOLDER

This list is the one place where the order stands; engine/docs/architecture.md explains it.
"""
import pathlib
import re
import sys

ORDER = [
    "engine/core",         # errors, files, stage times
    "engine/vulkan",       # device, buffers, pipelines, commands
    "engine/image",        # EXR, PNG, metrics
    "engine/scene",        # camera, lights, environment, settings: plain data
    "engine/volume",       # volume files, procedural volumes, classification
    "engine/octree",       # the volume on the device: occupied blocks and their medium
    "engine/attenuation",  # the table: sweeps, levels; rays from a source
    "engine/visibility",   # level of detail, culling
    "engine/lighting",     # light at voxels and in cells
    "engine/splatting",    # billboard splats, sums, resolve
    "engine/gathering",    # the compute gather
    "engine/storage",      # baked volumes on disk, one source of what is drawn
    "engine/description",  # what an image shows, as data: JSON in and out, and what it comes to for a volume
    "engine",              # the renderer and its memory planner
    "engine/reference",    # CPU references and oracle
    "engine/validation",   # checks and their report
    "apps/common",         # what programs share: scenes as options, frames and their files, messages
    "apps",                # the programs, each for itself
    "tests",
]
INCLUDE = re.compile(r'^\s*#include "((?:engine|apps|tests)/[^"]+)"', re.MULTILINE)


def place(path):
    """The position in ORDER of the folder that a file belongs to: the longest that matches."""
    folders = [folder for folder in ORDER if path.startswith(folder + "/")]
    return ORDER.index(max(folders, key=len)) if folders else None


def program(path):
    """The program that a file belongs to, if it is one's alone."""
    parts = path.split("/")
    return parts[1] if parts[0] == "apps" and len(parts) > 2 and parts[1] != "common" else None


def main(root):
    wrong = []
    for file in sorted(root.glob("*/**/*")):
        name = file.relative_to(root).as_posix()
        if file.suffix not in (".h", ".cpp") or not name.startswith(("engine/", "apps/", "tests/")):
            continue
        folder = pathlib.PurePosixPath(name).parent.as_posix()
        if folder.startswith("engine/") and folder not in ORDER:
            wrong.append(f"{name}: the folder {folder} has no place in the order (tests/include_order.py)")
            continue
        for included in INCLUDE.findall(file.read_text()):
            if place(included) > place(name):
                wrong.append(f"{name} includes {included}, which comes later")
            if program(name) and program(included) and program(name) != program(included):
                wrong.append(f"{name} includes {included}, which is of another program")
    print("\n".join(wrong) if wrong else "every include follows the order of the folders")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
