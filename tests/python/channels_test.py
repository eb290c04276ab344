"""Channels and clipping of arrays: the numbers that the command line writes for the same volume in an OpenVDB file."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import freevoxels
import numpy as np
import pyopenvdb

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "matrix"))
import exr_reader  # noqa: E402

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]
# The module is run with the validation layers; the program has tests of its own for that, and starts in half the time without.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "FREEVOXELS_VALIDATION"}
COMPONENTS = {"depth": ["Z"], "position": ["P.X", "P.Y", "P.Z"], "normal": ["N.X", "N.Y", "N.Z"], "transmittance": ["transmittance.Y"]}
ALL = ",".join(COMPONENTS)
SIZE = (50, 40)


def ball(shape, kind="f4"):
    """Dense in the middle, and nowhere 0."""
    places = np.meshgrid(*(np.linspace(-1, 1, n) if n > 1 else np.zeros(1) for n in shape), indexing="ij")
    return (0.01 + np.maximum(0, 2 - 3 * sum(place**2 for place in places))).astype(kind)


VOLUMES = {
    "a cube": (ball((24, 24, 24)), (1, 1, 1), (0, 0, 0)),
    "a box": (ball((9, 30, 17)), (1, 1, 2.5), (-3, 20, 7)),
    "a slab": (ball((1, 33, 20)), (0.25, 0.5, 1), (0, 0, -50)),
}
OPTIONS = ({}, {"transfer_function": '{"opacity": [[0, 0], [0.4, 0], [1, 0.6]]}'}, {"draw": "splats", "density_scale": 0.7}, {"orthographic": 40, "orbit": (120, -20)})


def words_of(options):
    words = []
    for name, value in options.items():
        words += ["--" + name.replace("_", "-"), ",".join(map(str, value)) if isinstance(value, tuple) else str(value)]
    return words


class ChannelsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def written(self, array, spacing, origin):
        grid = pyopenvdb.FloatGrid()
        grid.copyFromArray(np.ascontiguousarray(array.transpose(2, 1, 0).astype("f4")))
        grid.name = "density"  # and of no class, as an array
        matrix = np.diag([*spacing, 1.0])
        matrix[3, :3] = origin
        grid.transform = pyopenvdb.createLinearTransform(matrix.tolist())
        file = self.folder / "volume.vdb"
        pyopenvdb.write(str(file), grids=[grid])
        return file

    def drawn(self, file, **options):
        image = self.folder / "image.exr"
        subprocess.run([PROGRAM, "render", file, image, "--quiet", "--float", "--size", "50x40", *words_of(options)], check=True, env=ENVIRONMENT)
        return exr_reader.read(image)

    def expect_same(self, returned, expected, what):
        image, channels = returned
        self.assertEqual(set(channels), {name for name, parts in COMPONENTS.items() if parts[0] in expected}, what)
        for index, name in enumerate("RGBA"):
            np.testing.assert_array_equal(image[..., index], expected[name], str(what))
        for name, array in channels.items():
            parts = COMPONENTS[name]
            self.assertEqual((array.shape, array.dtype), ((40, 50, 3) if len(parts) == 3 else (40, 50), np.dtype("f4")), what)
            for index, part in enumerate(parts):
                np.testing.assert_array_equal(array[..., index] if len(parts) == 3 else array, expected[part], f"{what} {part}")

    def test_channels_are_those_of_the_command_line(self):
        for name, (array, spacing, origin) in VOLUMES.items():
            file = self.written(array, spacing, origin)
            for options in OPTIONS:
                expected = self.drawn(file, aov=ALL, **options)
                self.assertTrue(np.isfinite(expected["Z"]).any(), (name, options))
                sources = [freevoxels.Volume(array, spacing=spacing, origin=origin)]
                if not options:  # of files with options there are the cases of matrix_test.py
                    sources.append(freevoxels.Volume.open(file))
                for source in sources:
                    self.expect_same(freevoxels.render(source, aov=ALL, size=SIZE, **options), expected, (name, options))

    def test_each_can_be_had_alone(self):
        array, spacing, origin = VOLUMES["a box"]
        every = self.drawn(self.written(array, spacing, origin), aov=ALL)
        renderer = freevoxels.Renderer(freevoxels.Volume(array, spacing=spacing, origin=origin), size=SIZE)
        for wanted in ("depth", "position", "normal", "transmittance", "normal,depth", ["position", "transmittance"], ("normal",)):
            names = wanted.split(",") if isinstance(wanted, str) else wanted
            expected = {part: every[part] for part in (*"RGBA", *(part for name in names for part in COMPONENTS[name]))}
            self.expect_same(renderer.render(aov=wanted), expected, wanted)
        turn = list(renderer.turntable(3, aov="position,depth"))
        self.assertEqual([sorted(channels) for _, channels in turn], [["depth", "position"]] * 3)
        self.assertFalse(np.array_equal(turn[0][1]["position"], turn[1][1]["position"]))

    def test_what_is_saved_is_what_was_returned(self):
        array, spacing, origin = VOLUMES["a cube"]
        image, channels = freevoxels.render(array, spacing=spacing, origin=origin, size=SIZE, aov=ALL)
        file = self.folder / "saved.exr"
        for given in (channels, {name: np.asfortranarray(values.astype(">f8")) for name, values in channels.items()}, {"normal": channels["normal"]}, {}):
            freevoxels.save(file, image, aov=given, float=True)
            saved = exr_reader.read(file)
            self.assertEqual(set(saved), {*"RGBA", *(part for name in given for part in COMPONENTS[name])})
            self.expect_same((image, {name: channels[name] for name in given}), saved, list(given))

    def test_arrays_are_clipped_as_files_are(self):
        for name, (array, spacing, origin) in VOLUMES.items():
            file = self.written(array, spacing, origin)
            middle = [o + s * (n - 1) / 2 for o, s, n in zip(origin, spacing, reversed(array.shape))]
            for options in ({"clip_box": (2, 3, 0, 15, 14, 7)}, {"clip_plane": (*middle, 1, 0.5, 0)}, {"clip_box": (0, 0, 0, 9, 99, 99), "clip_plane": (*middle, 0, -1, 0)}):
                expected = self.drawn(file, aov=ALL, **options)
                returned = freevoxels.render(array, spacing=spacing, origin=origin, size=SIZE, aov=ALL, **options)
                self.expect_same(returned, expected, (name, options))

    def test_what_is_no_channel_is_refused(self):
        array = VOLUMES["a cube"][0]
        image, channels = freevoxels.render(array, size=(6, 5), aov="normal")
        for call, sentence in (
            (lambda: freevoxels.render(array, aov="dept"), "'aov' takes depth, position, normal, transmittance, lights and channels, .* not 'dept'"),
            (lambda: freevoxels.render(array, aov=""), "'aov' takes depth"),
            (lambda: freevoxels.render(array, aov=5), "'aov' takes names of channels as text, not int"),
            (lambda: freevoxels.render(array, aov=array), "'aov' takes names of channels as text, not ndarray"),
            (lambda: freevoxels.render(array, aov={"depth": True}), "'aov' takes names of channels as text, not dict"),
            (lambda: freevoxels.render(array, aov="depth", depth=True), "'depth' and 'aov' exclude each other"),
            (lambda: freevoxels.save("none.png", image, aov=channels), "'aov' needs an .exr output"),
            (lambda: freevoxels.save("none.exr", image, aov={"normals": image}), "'aov' takes depth, .* not 'normals'"),
            (lambda: freevoxels.save("none.exr", image, aov={"normal": image}), "'aov.normal' to save has the shape .height, width, 3."),
            (lambda: freevoxels.save("none.exr", image, aov={"depth": channels["normal"]}), "'aov.depth' to save has the shape .height, width."),
            (lambda: freevoxels.save("none.exr", image, aov={"depth": "far"}), "'aov.depth' is the name of a file"),
            (lambda: freevoxels.save("none.exr", image, depth=np.ones((5, 6)), aov={"depth": np.ones((5, 6))}), "'depth' is given twice"),
        ):
            with self.assertRaisesRegex(freevoxels.Error, sentence) as caught:
                call()
            self.assertLess(len(str(caught.exception)), 250)


if __name__ == "__main__":
    unittest.main()
