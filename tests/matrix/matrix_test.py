"""Draws every case of cases.json with the command line and with the Python module, and compares the bits of what they write. What one of
them cannot draw it refuses, with the sentence of the table."""

import concurrent.futures
import fnmatch
import itertools
import json
import logging
import pathlib
import re
import shutil
import struct
import tempfile
import unittest

import freevoxels
import numpy as np
from drivers import CommandLine, Module, Refused, run

TABLE = json.loads(pathlib.Path(__file__).with_name("cases.json").read_text())
logging.getLogger("freevoxels").setLevel(logging.ERROR)


def blob(shape):
    """A soft ball with a dent."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n, dtype="float32") for n in shape], indexing="ij")
    return np.maximum(1 - np.sqrt(x * x + y * y + z * z) + 0.3 * np.sin(5 * x), 0).astype("float32")


def grid_of(name, shape):
    import pyopenvdb

    density = np.ascontiguousarray(blob(shape).transpose(2, 1, 0))
    if name == "surface":
        return pyopenvdb.createLevelSetSphere(radius=min(shape) / 2, center=[n / 2 for n in shape[::-1]], voxelSize=1.0)
    if name == "nothing":
        return pyopenvdb.FloatGrid()
    if name == "parts":
        grid = pyopenvdb.BoolGrid()
        grid.copyFromArray(density > 0.4)
        return grid
    if name == "paint":
        grid, values = pyopenvdb.Vec3SGrid(), np.stack([density, 1 - density, 0.5 + 0 * density], axis=-1).clip(0, 1)
    else:
        grid, values = pyopenvdb.FloatGrid(), {"smoke": density, "heat": 2500 * density**2}[name]
    grid.copyFromArray(values)
    return grid


def dicom_slice(values, number, series):
    """Explicit and little-endian, 2.5 mm above the one before."""

    def element(group, member, form, value):
        if isinstance(value, str):
            value = value.encode()
            value += (b"\0" if form == "UI" else b" ") * (len(value) % 2)
        head = struct.pack("<HH2s", group, member, form.encode())
        return head + (struct.pack("<xxI", len(value)) if form == "OW" else struct.pack("<H", len(value))) + value

    kind, name = "1.2.840.10008.5.1.4.1.1.2", f"{series}.{number}"
    meta = element(2, 2, "UI", kind) + element(2, 3, "UI", name) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1")
    data = element(8, 0x16, "UI", kind) + element(8, 0x18, "UI", name) + element(0x20, 0xE, "UI", series)
    data += element(0x20, 0x32, "DS", f"0\\0\\{2.5 * number}") + element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0")
    data += element(0x28, 2, "US", b"\1\0") + element(0x28, 4, "CS", "MONOCHROME2")
    data += element(0x28, 0x10, "US", struct.pack("<H", values.shape[0])) + element(0x28, 0x11, "US", struct.pack("<H", values.shape[1]))
    data += element(0x28, 0x30, "DS", "1\\1") + b"".join(element(0x28, tag, "US", struct.pack("<H", n))
                                                         for tag, n in ((0x100, 16), (0x101, 16), (0x102, 15), (0x103, 0)))
    data += element(0x28, 0x1052, "DS", "-1024") + element(0x28, 0x1053, "DS", "1") + element(0x7FE0, 0x10, "OW", values.astype("<u2").tobytes())
    return bytes(128) + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + data


def write_zarr(folder, values):
    """An OME-Zarr of one chunk, with two channels."""
    chunk = folder / "0/0/0/0/0"
    chunk.parent.mkdir(parents=True)
    chunk.write_bytes(values.tobytes())
    array = {"zarr_format": 2, "shape": values.shape, "chunks": values.shape, "dtype": "<u2", "compressor": None, "fill_value": 0, "order": "C",
             "filters": None, "dimension_separator": "/"}
    (folder / "0/.zarray").write_text(json.dumps(array))
    axes = [{"name": "c", "type": "channel"}] + [{"name": name, "type": "space", "unit": "millimeter"} for name in "zyx"]
    scale = {"type": "scale", "scale": [1, 2, 1, 1.5]}
    image = {"version": "0.4", "axes": axes, "datasets": [{"path": "0", "coordinateTransformations": [scale]}]}
    channels = [{"label": "a", "color": "FF8000", "window": {"start": 100, "end": 900}}, {"label": "b", "color": "0000FF", "window": {"start": 300, "end": 1000}}]
    (folder / ".zattrs").write_text(json.dumps({"multiscales": [image], "omero": {"channels": channels}}))


def write_scan(file, shape):
    values = 1000 * blob(shape)
    if file.suffix == ".raw":
        file.write_bytes(bytes(7) + values.astype(">i2").tobytes())
    elif file.suffix == ".nrrd":
        sizes = " ".join(map(str, values.shape[::-1]))
        header = f"NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: {sizes}\n"
        header += "space directions: (0,1.5,0) (0,0,2) (1,0,0)\nspace origin: (3,4,5)\nendian: little\nencoding: raw\n\n"
        file.write_bytes(header.encode() + values.tobytes())
    elif file.suffix == ".nii":
        sizes = np.array([4, *values.shape[::-1], 2, 1, 1, 1], "<i2")
        header = bytearray(352)
        header[0:4], header[40:56], header[70:74] = struct.pack("<i", 348), sizes.tobytes(), struct.pack("<2h", 16, 32)
        header[76:96], header[108:120] = struct.pack("<5f", 1, 1, 1, 1, 1), struct.pack("<3f", 352, 2, -10)
        header[344:347] = b"n+1"
        file.write_bytes(bytes(header) + values.tobytes() + values[::-1].tobytes())
    elif file.suffix == ".zarr":
        write_zarr(file, np.stack([values, 1000 - values]).astype("<u2"))
    else:
        file.mkdir()
        for series, step in (("1.2.3", 1), ("1.2.4", -1)):
            for number, of_slice in enumerate(values[::step]):
                (file / f"{series}_{number}").write_bytes(dicom_slice(of_slice + 1024, number, series))


def write(file, kind):
    if "grids" not in kind and file.suffix != ".exr":
        return write_scan(file, kind["shape"])
    if file.suffix == ".exr":
        image = np.ones((*kind["shape"], 4), "float32")
        image[..., :3] = np.random.default_rng(1).random((*kind["shape"], 3))
        return freevoxels.save(file, image)
    import pyopenvdb

    grids = []
    for name in kind["grids"]:
        grids.append(grid_of(name, kind["shape"]))
        grids[-1].name = "density" if name == "nothing" else name
    pyopenvdb.write(str(file), grids)


def cases():
    """The cases of all groups, by name: every volume with all options, or, "in turn", each of the options with the next volume."""
    for group, parts in TABLE["groups"].items():
        volumes, options = parts["volumes"], parts["options"]
        pairs = zip(itertools.cycle(volumes), options) if parts.get("in turn") else itertools.product(volumes, options)
        for (volume, chosen), output in itertools.product(pairs, parts.get("outputs", [{}])):
            given = {**TABLE["volumes"][volume], **TABLE["common"], **chosen}
            case = {key: parts[key] for key in ("command", "names", "forms", "python", "refused", "empty") if key in parts}
            yield f"{group}: {volume} {chosen} {output}", {**case, "volume": given.pop("volume"), "options": given, "output": output}


class MatrixTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.files = cls.folder / "files"
        cls.files.mkdir()
        for name, kind in TABLE["files"]["written"].items():
            write(cls.files / name, kind)
        for command, *words in TABLE["files"]["made"]:
            run([command, *(str(cls.files / word) if word.endswith((".vdb", ".fvx", ".exr")) else word for word in words), "--quiet"])
        for name, copy in TABLE["files"]["copied"].items():
            shutil.copyfile(cls.files / name, cls.files / copy)

    def outcome(self, driver, number, case):
        """What a driver draws, or the sentence with which it refuses."""
        folder = self.folder / f"{number}_{type(driver).__name__}"
        folder.mkdir()
        try:
            return driver.draw(case, folder)
        except Refused as refused:
            return str(refused)

    def expect_refused(self, driver, sentence, outcome):
        expected = driver.spelled(sentence)
        self.assertIsInstance(outcome, str, f"{type(driver).__name__} draws what it should refuse: {expected}")
        agrees = fnmatch.fnmatchcase(outcome, expected.replace("[", "[[]"))
        self.assertTrue(agrees, f"{type(driver).__name__} says\n  {outcome}\nnot\n  {expected}")

    def expect_same(self, theirs, ours, empty):
        """`empty` is how many images show nothing."""
        self.assertIsInstance(theirs, dict, theirs)
        self.assertIsInstance(ours, dict, ours)
        self.assertEqual(list(ours), list(theirs))
        self.assertEqual(sum(file["A"].max() < 0.02 for file in theirs.values() if isinstance(file, dict)), empty, "nothing is seen")
        for name, file in theirs.items():
            if isinstance(file, bytes):
                self.assertTrue(file == ours[name], f"{name} has other bytes")
                continue
            self.assertEqual(list(ours[name]), list(file))
            for channel, values in file.items():
                np.testing.assert_array_equal(ours[name][channel], values, f"{name} {channel}")

    def check(self, case, theirs, ours):
        command, module = CommandLine(self.files), Module(self.files)
        if sentence := case.get("refused"):
            self.expect_refused(command, sentence, theirs)
            return self.expect_refused(module, sentence, ours)
        self.assertIsInstance(theirs, dict, theirs)
        self.assertTrue(theirs, "nothing is written")
        if refusal := case.get("python"):
            return self.expect_refused(module, refusal.removeprefix("refused: "), ours)
        self.expect_same(theirs, ours, case.get("empty", 0))

    def test_every_option_is_in_the_table(self):
        keys = pathlib.Path(__file__).parents[2] / "apps" / "scenes" / "README.md"
        listed = set(re.findall(r"^\| `([\w-]+)` \|", keys.read_text(), re.MULTILINE))
        self.assertGreater(len(listed), 50)
        used = {name for _, case in cases() for name in (*case["options"], *case["output"])}
        # Of the drivers; `lights`, `channels` and `volumes` are `light`, `channel` and `add` as files have them.
        implied = {"volume", "float", "lights", "channels", "volumes"}
        self.assertEqual(listed - used - implied, set())

    def test_command_line_and_module_agree(self):
        table = list(cases())
        self.assertEqual(len(table), len(dict(table)), "a case is there twice")
        with concurrent.futures.ThreadPoolExecutor(1) as elsewhere:
            drawn = [elsewhere.submit(self.outcome, CommandLine(self.files), number, case) for number, (name, case) in enumerate(table)]
            for number, (name, case) in enumerate(table):
                ours = self.outcome(Module(self.files), number, case)
                with self.subTest(name):
                    self.check(case, drawn[number].result(), ours)


if __name__ == "__main__":
    unittest.main()
