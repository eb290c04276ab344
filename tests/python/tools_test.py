"""What the module does beside drawing: bake(), convert(), info(), merge(), devices(), presets(). Files and facts are those of the command line."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import freevoxels
import numpy as np

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]


class Abandoned(Exception):
    pass


class ToolsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words):
        ran = subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True)
        return json.loads(ran.stdout) if "--json" in words else ran.stdout

    def test_devices_are_those_of_the_command_line(self):
        self.assertEqual(freevoxels.devices(), self.run_program("devices", "--json"))
        self.assertIn(freevoxels.Renderer(freevoxels.Volume([[[1.0, 2.0]]])).device, [device["name"] for device in freevoxels.devices()])

    def test_presets_are_those_of_the_command_line_and_can_be_changed(self):
        presets = freevoxels.presets()
        self.assertEqual(presets, self.run_program("presets", "--json"))
        for name, function in presets.items():
            self.assertRegex(function["description"], r"\w{3,}", name)
        look = {"resolution": 24, "size": (40, 30), "unlit": True}
        named = freevoxels.render("procedural:shells", transfer_function="viridis", **look)
        np.testing.assert_array_equal(named, freevoxels.render("procedural:shells", transfer_function=presets["viridis"], **look))
        presets["viridis"]["opacity"] = [[0, 0], [1, 0.9]]
        self.assertFalse(np.array_equal(named, freevoxels.render("procedural:shells", transfer_function=presets["viridis"], **look)))

    def test_baked_files_have_the_bytes_of_the_command_lines(self):
        self.run_program("generate", "cloud", self.folder / "a.vdb", "--resolution", "12x20x9")
        function = '{"range": [0, 1], "opacity": [[0, 0], [1, 0.4]], "color": [[0, 1, 0.5, 0.3], [1, 1, 1, 0.9]]}'
        for volume, keywords in (
            ("procedural:cloud", {"resolution": "33x20x9"}),
            ("procedural:fire", {"resolution": 17, "emission": 3, "keep_scalars": True}),
            (self.folder / "a.vdb", {"density_scale": 30, "compress": True}),
            (str(self.folder / "a.vdb"), {"albedo": (0.3, 0.4, 0.5), "keep_scalars": True, "compress": True}),
            (self.folder / "a.vdb", {"transfer_function": function}),
        ):
            flags = []
            for name, value in keywords.items():
                text = ",".join(map(str, value)) if isinstance(value, tuple) else value
                flags += [f"--{name}".replace("_", "-")] + ([] if value is True else [text])
            self.run_program("bake", volume, self.folder / "theirs.fvx", *flags)
            freevoxels.bake(volume, self.folder / "ours.fvx", **keywords)
            self.assertEqual((self.folder / "ours.fvx").read_bytes(), (self.folder / "theirs.fvx").read_bytes(), keywords)
            self.assertEqual(freevoxels.info(self.folder / "ours.fvx", check=True), self.run_program("info", self.folder / "theirs.fvx", "--json"))
        for volume, keywords, flags in ((self.folder / "a.vdb", {}, []), ("procedural:head", {"resolution": (9, 8, 7)}, ["--resolution", "9x8x7"])):
            self.assertEqual(freevoxels.info(volume, **keywords), self.run_program("info", volume, "--json", *flags))

    def test_arrays_and_volumes_are_baked(self):
        for shape in ((4, 4, 4), (20, 30, 17)):
            array = np.random.default_rng(1).random(shape, dtype="float32")
            freevoxels.bake(array, self.folder / "array.fvx", spacing=(1, 1, 2.5), keep_scalars=True)
            baked = freevoxels.render(self.folder / "array.fvx", size=(40, 30))
            np.testing.assert_array_equal(baked, freevoxels.render(array, spacing=(1, 1, 2.5), size=(40, 30)))
            volume = freevoxels.Volume.open(self.folder / "array.fvx")
            freevoxels.bake(volume, self.folder / "again.fvx", keep_scalars=True)
            np.testing.assert_array_equal(freevoxels.render(self.folder / "again.fvx", size=(40, 30)), baked)
            freevoxels.bake(freevoxels.Volume(array, spacing=(1, 1, 2.5)), self.folder / "volume.fvx", keep_scalars=True)
            self.assertEqual((self.folder / "volume.fvx").read_bytes(), (self.folder / "array.fvx").read_bytes())

    def test_converted_files_have_the_bytes_of_the_command_lines(self):
        self.run_program("convert", "procedural:head", self.folder / "theirs.nrrd", "--resolution", "12x9x10")
        stages = []
        freevoxels.convert("procedural:head", self.folder / "ours.nrrd", resolution=(12, 9, 10), progress=lambda stage, fraction: stages.append(stage))
        self.assertEqual((self.folder / "ours.nrrd").read_bytes(), (self.folder / "theirs.nrrd").read_bytes())
        self.assertIn("writing the file", stages)
        freevoxels.convert(self.folder / "ours.nrrd", self.folder / "ours.nii.gz", no_data="none")
        shape = freevoxels.Volume.open("procedural:head", resolution=(12, 9, 10)).shape  # of its voxels with data
        self.assertEqual(freevoxels.Volume.open(self.folder / "ours.nii.gz").shape, shape)
        with self.assertRaisesRegex(freevoxels.UsageError, ".nrrd"):
            freevoxels.convert("procedural:head", self.folder / "a.png")
        with self.assertRaisesRegex(freevoxels.UsageError, "no volume to convert"):
            freevoxels.convert("", self.folder / "a.nrrd")

    def test_parts_are_merged(self):
        for index in (0, 1, 2):
            self.run_program("render", "procedural:cloud", self.folder / f"part_{index}.exr", "--share", f"{index}/3", "--sums", "--size", "40x30",
                             "--resolution", "16")
        parts = [self.folder / f"part_{index}.exr" for index in (2, 0, 1)]
        self.run_program("merge", *parts, self.folder / "theirs.png", "--exposure", "1")
        freevoxels.merge(parts, self.folder / "ours.png", exposure=1)
        self.assertEqual((self.folder / "ours.png").read_bytes(), (self.folder / "theirs.png").read_bytes())
        with self.assertRaisesRegex(freevoxels.InputError, "share 1/3 is missing"):
            freevoxels.merge(parts[:2], self.folder / "none.png")
        with self.assertRaisesRegex(freevoxels.UsageError, "is no file of sums"):
            freevoxels.merge(self.folder / "ours.png", self.folder / "none.png")
        with self.assertRaisesRegex(freevoxels.UsageError, "nothing to merge"):
            freevoxels.merge([], [])

    def test_baking_is_abandoned_by_an_exception(self):
        for volume, keywords in ((np.ones((40, 30, 20), "float32"), {}), ("procedural:cloud", {"resolution": 64})):
            stages = []
            freevoxels.bake(volume, self.folder / "a.fvx", progress=lambda stage, fraction: stages.append(stage), **keywords)
            before = (self.folder / "a.fvx").read_bytes()
            for stage in set(stages):

                def abandon(now, fraction):
                    if now == stage:
                        raise Abandoned(stage)

                with self.assertRaisesRegex(Abandoned, f"^{stage}$"):
                    freevoxels.bake(volume, self.folder / "a.fvx", progress=abandon, **keywords)
                self.assertEqual([file.name for file in self.folder.iterdir()], ["a.fvx"])
                self.assertEqual((self.folder / "a.fvx").read_bytes(), before)

    def test_what_makes_no_sense_is_named(self):
        array = np.ones((4, 4, 4), "float32")
        file = self.folder / "a.fvx"
        freevoxels.bake(array, file)
        usage = freevoxels.UsageError
        for error, part, work in (
            (usage, "is not named .fvx", lambda: freevoxels.bake(array, "x.vdb")),
            (usage, "there is no volume to bake", lambda: freevoxels.bake(None, file)),
            (usage, "'orbit' has no effect here", lambda: freevoxels.bake("procedural:cloud", file, orbit=(1, 2))),
            (usage, "'clip_box' has no effect here", lambda: freevoxels.bake("procedural:cloud", file, clip_box=(1, 1, 1, 4, 4, 4))),
            (usage, "'spacing' is for scans", lambda: freevoxels.bake("procedural:cloud", file, spacing=2)),
            (usage, "'compress' takes True or False", lambda: freevoxels.bake(array, file, compress=1)),
            (usage, "'a.fvx (the array)' was baked for one classification", lambda: freevoxels.bake(freevoxels.Volume.open(file), self.folder / "b.fvx")),
            (usage, "was baked for one classification", lambda: freevoxels.bake(file, self.folder / "b.fvx")),
            (usage, "are the same file", lambda: freevoxels.bake(file, file)),
            (freevoxels.InputError, "there is no file '/none.vdb'", lambda: freevoxels.bake("/none.vdb", file)),
            (freevoxels.OutputError, "there is no folder", lambda: freevoxels.bake(array, "/none/a.fvx")),
            (usage, "'check' is for baked volumes", lambda: freevoxels.info("procedural:cloud", check=True)),
            (usage, "'size' has no effect here", lambda: freevoxels.info("procedural:cloud", size=3)),
            (freevoxels.InputError, "there is no file '/none.vdb'", lambda: freevoxels.info("/none.vdb")),
        ):
            with self.assertRaises(error, msg=part) as raised:
                work()
            self.assertIn(part, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
