"""Films: what a Sequence knows of its files, its view, progress and abandonment, damaged frames; and render_sequence(). That the images are
the command line's is a matter of tests/matrix."""

import concurrent.futures
import os
import pathlib
import subprocess
import tempfile
import unittest

import freevoxels
import numpy as np

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]
SMALL = {"size": (28, 20)}


class Abandoned(Exception):
    pass


def distance(camera):
    return float(np.linalg.norm(np.subtract(camera["camera_position"], camera["look_at"])))


class SequenceTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def make(self, name, resolution, kind="cloud"):
        subprocess.run([PROGRAM, "generate", kind, self.folder / name, "--resolution", resolution, "--quiet"], check=True)

    def film(self, pattern="s_{:02}.vdb", numbers=(1, 2, 3)):
        for number, resolution in zip(numbers, ("12", "9x14x11", "17", "8x8x20")):
            self.make(pattern.format(number), resolution)
        return self.folder / "s_##.vdb"

    def test_files_and_numbers_are_those_of_the_folder(self):
        pattern = self.film(numbers=(-1, 4, 12))
        self.make("s_05.5.vdb", "8")
        sequence = freevoxels.Sequence(pattern, **SMALL)
        self.assertEqual((len(sequence), sequence.numbers), (4, [-1, 4, 5.5, 12]))
        self.assertEqual([pathlib.Path(file).name for file in sequence.files], ["s_-1.vdb", "s_04.vdb", "s_05.5.vdb", "s_12.vdb"])
        self.assertEqual(repr(sequence), f"<freevoxels.Sequence of 4 frames from {sequence.files[0]}>")
        for frames, chosen in ((range(4, 13), [4, 12]), (range(-1, 5), [-1, 4]), (range(0, 13, 6), [12]), ("4-6", [4, 5.5]), (12, [12]),
                               (np.int64(4), [4])):
            self.assertEqual(freevoxels.Sequence(pattern, frames=frames).numbers, chosen, frames)
        with self.assertLogs("freevoxels", "WARNING") as logs:
            freevoxels.Sequence(str(pattern), frames=range(3, 7))
        self.assertIn("has no file of frame 3, 5, 6", logs.output[0])

    def test_volumes_may_be_listed(self):
        self.film()
        names = [self.folder / "s_03.vdb", "procedural:shells", str(self.folder / "s_01.vdb")]
        sequence = freevoxels.Sequence(names, **SMALL)
        self.assertEqual((sequence.files, sequence.numbers), ([str(name) for name in names], [0, 1, 2]))
        self.assertEqual([image.shape for image in sequence], 3 * [(20, 28, 4)])
        scene = {"volume": str(self.folder / "s_##.vdb"), "camera": {"orbit": (10, 20), "frames": 9}, **SMALL}
        freevoxels.save_scene(self.folder / "film.json", **scene)
        loaded = freevoxels.load_scene(self.folder / "film.json")
        self.assertEqual(len(freevoxels.Sequence(**loaded)), 3)
        np.testing.assert_array_equal(freevoxels.Sequence(**loaded).render(1), freevoxels.Sequence(**scene).render(1))

    def test_the_eye_moves_about_the_films_middle_at_one_distance(self):
        for options in ({}, {"fixed_view": True}, {"orbit": (50, 10), "fov": 20}, {"orthographic": 3}, {"camera_position": (2, 1, 4)}):
            sequence = freevoxels.Sequence(self.film(), **SMALL, **options)
            sequence.render(0)
            first = sequence.camera
            for place in range(3):
                sequence.render(place, orbit=(40 * place, 15))
                self.assertAlmostEqual(distance(sequence.camera), distance(first), places=9)
                np.testing.assert_allclose(sequence.camera["look_at"], first["look_at"])
                offset = np.subtract(sequence.camera["camera_position"], sequence.camera["look_at"]) / distance(first)
                self.assertAlmostEqual(float(np.degrees(np.arcsin(offset[1]))), 15, places=6)
            sequence.render(2)
            self.assertEqual(sequence.camera, first, options)
        frame = sequence.render(1, density_scale=0.0)
        self.assertEqual(frame.max(), 0)
        self.assertEqual(sequence.render(1, size=(10, 30)).shape, (30, 10, 4))

    def test_default_lights_stay_while_the_eye_moves_and_a_frame_may_have_others(self):
        sequence = freevoxels.Sequence(self.film(), density_scale=8, **SMALL)
        fixed = sequence.render(1)
        sequence.render(1, orbit=(180, 0))
        self.assertNotIn("light sweep", [stage for stage, _ in sequence.timings])
        np.testing.assert_array_equal(sequence.render(1), fixed)
        self.assertLess(sequence.render(1, density_scale=0.1)[..., 3].max(), 0.5 * fixed[..., 3].max())
        self.assertEqual(sequence.render(1, albedo=(0, 0, 0))[..., :3].max(), 0)
        colors = {"opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0, 0], [1, 1, 0, 0]]}
        self.assertEqual(sequence.render(1, transfer_function=colors)[..., 1:3].max(), 0)
        unlit = sequence.render(1, unlit=True)
        np.testing.assert_allclose(unlit[..., 3], fixed[..., 3], atol=1e-3)
        self.assertGreater(abs(unlit - fixed).max(), 0.01)
        np.testing.assert_array_equal(sequence.render(1), fixed)

    def test_a_film_that_burns_may_be_put_out(self):
        for number in (1, 2):
            self.make(f"f_{number}.vdb", f"1{number}", "fire")
        sequence = freevoxels.Sequence(self.folder / "f_#.vdb", albedo=(0, 0, 0), **SMALL)
        self.assertGreater(sequence.render(1)[..., :3].max(), 0.05)
        self.assertEqual(sequence.render(1, emission=False)[..., :3].max(), 0)
        self.assertGreater(sequence.render(1, emission=100)[..., :3].max(), 2 * sequence.render(1, emission=30)[..., :3].max())
        self.make("f_3.vdb", "12")
        smoke = freevoxels.Sequence([self.folder / "f_3.vdb", "procedural:shells"], **SMALL)
        smoke.render(0)
        with self.assertRaisesRegex(freevoxels.UsageError, "give 'emission' for the whole sequence"):
            smoke.render(0, emission=True)

    def test_progress_grows_to_one_and_may_abandon(self):
        sequence = freevoxels.Sequence(self.film(), **SMALL)
        for place in (0, 0, 2):
            fractions = []
            whole = sequence.render(place, progress=lambda stage, fraction: fractions.append(fraction))
            self.assertEqual((fractions, fractions[-1]), (sorted(fractions), 1.0))
        for calls in (0, 1):
            left = [calls]

            def abandon(stage, fraction):
                left[0] -= 1
                if left[0] < 0:
                    raise Abandoned

            fresh = freevoxels.Sequence(self.folder / "s_##.vdb", **SMALL)
            with self.assertRaises(Abandoned):
                fresh.render(2, progress=abandon)
            self.assertIsNone(fresh.camera)
            np.testing.assert_array_equal(fresh.render(2), whole)
        with self.assertRaisesRegex(freevoxels.UsageError, "in the progress function of another of its frames"):
            sequence.render(1, progress=lambda *_: sequence.render(2))
        np.testing.assert_array_equal(sequence.render(2, progress=lambda *_: fresh.render(0) is None), whole)

    def test_threads_share_a_sequence(self):
        sequence = freevoxels.Sequence(self.film(), **SMALL)
        expected = list(sequence)
        with concurrent.futures.ThreadPoolExecutor(3) as threads:
            for place, image in enumerate(threads.map(freevoxels.Sequence(self.folder / "s_##.vdb", **SMALL).render, (0, 1, 2))):
                np.testing.assert_array_equal(image, expected[place])

    def test_a_damaged_frame_fails_and_the_others_are_drawn(self):
        pattern = self.film()
        (self.folder / "s_02.vdb").write_text("no volume")
        sequence = freevoxels.Sequence(pattern, **SMALL)
        with self.assertRaisesRegex(freevoxels.InputError, "s_02.vdb"):
            sequence.render(1)
        with self.assertRaisesRegex(freevoxels.InputError, "s_02.vdb"):
            list(sequence)
        self.assertGreater(sequence.render(2)[..., 3].max(), 0.1)
        with self.assertRaisesRegex(freevoxels.InputError, "1 of 3 volumes could not be drawn: .*s_02.vdb"):
            freevoxels.render_sequence(pattern, self.folder / "i_##.png", **SMALL)
        self.assertEqual(sorted(file.name for file in self.folder.glob("i_*")), ["i_01.png", "i_03.png"])

    def test_a_film_of_nothing_is_an_error(self):
        (self.folder / "s_01.vdb").write_text("no volume")
        (self.folder / "s_02.vdb").write_text("")
        for options in ({}, {"fixed_view": True}):
            with self.assertRaisesRegex(freevoxels.InputError, "no frame of 2 holds anything to draw"):
                freevoxels.Sequence(self.folder / "s_##.vdb", **options).render(1)

    def test_images_are_written_once_and_where_they_are_missing(self):
        pattern, images = self.film(), [str(self.folder / "i_#.exr"), self.folder / "i_#.png"]
        fractions = []
        written = freevoxels.render_sequence(pattern, images, progress=lambda stage, fraction: fractions.append((stage, fraction)),
                                             background=(1, 0, 0), aov="depth", **SMALL)
        self.assertEqual([pathlib.Path(file).name for file in written], ["i_1.exr", "i_1.png", "i_2.exr", "i_2.png", "i_3.exr", "i_3.png"])
        self.assertEqual([fraction for _, fraction in fractions], sorted(fraction for _, fraction in fractions))
        self.assertEqual((fractions[0][0][:14], fractions[-1][1]), ("frame 1 of 3: ", 1.0))
        before = {file: pathlib.Path(file).read_bytes() for file in written}
        pathlib.Path(written[3]).unlink()
        pathlib.Path(written[0]).write_bytes(b"as it is")
        options = {"background": (1, 0, 0), "aov": "depth", **SMALL}
        self.assertEqual(freevoxels.render_sequence(pattern, images, skip_existing=True, **options), written)
        for file in written[1:]:
            self.assertEqual(pathlib.Path(file).read_bytes(), before[file], file)
        self.assertEqual(pathlib.Path(written[0]).read_bytes(), b"as it is")

        def abandon(stage, fraction):
            if stage.startswith("frame 2"):
                raise Abandoned

        with self.assertRaises(Abandoned):
            freevoxels.render_sequence(pattern, self.folder / "j_#.png", progress=abandon, **SMALL)
        self.assertEqual([file.name for file in self.folder.glob("j_*")], ["j_1.png"])

    def test_what_makes_no_sense_is_named(self):
        pattern = self.film()
        one = str(self.folder / "s_01.vdb")
        usage, wrong = freevoxels.UsageError, freevoxels.InputError
        for error, part, work in (
            (usage, "there is no volume to draw", lambda: freevoxels.Sequence()),
            (wrong, "there is no frame of 'x_##.vdb'", lambda: freevoxels.Sequence("x_##.vdb")),
            (usage, "'volume' takes the name of a file or pattern, or a list of them, not int", lambda: freevoxels.Sequence(3)),
            (usage, "is named twice", lambda: freevoxels.Sequence([one, one])),
            (usage, "'frames' chooses among the files of a pattern", lambda: freevoxels.Sequence(one, frames=1)),
            (usage, "'frames' takes A-B", lambda: freevoxels.Sequence(pattern, frames="1..2")),
            (usage, "'frames' takes A-B", lambda: freevoxels.Sequence(pattern, frames=[1, 2])),
            (usage, "'frames' takes a range of numbers that increase", lambda: freevoxels.Sequence(pattern, frames=range(3, 1, -1))),
            (wrong, "its numbers are from 1 to 3", lambda: freevoxels.Sequence(pattern, frames=range(7, 9))),
            (usage, "'fixed_view' takes True or False, not str", lambda: freevoxels.Sequence(pattern, fixed_view="yes")),
            (usage, "did you mean 'density_scale'", lambda: freevoxels.Sequence(pattern, densty_scale=3)),
            (usage, "'origin' is an option of arrays", lambda: freevoxels.Sequence(pattern, origin=(1, 2, 3))),
            (usage, "'frame' is the place of a frame in the sequence, from 0 to 2, not 3", lambda: freevoxels.Sequence(pattern).render(3)),
            (usage, "'frame' is the place of a frame in the sequence, from 0 to 2, not -1", lambda: freevoxels.Sequence(pattern).render(-1)),
            (usage, "not 1.5", lambda: freevoxels.Sequence(pattern).render(1.5)),
            (usage, "'grid' has no effect here", lambda: freevoxels.Sequence(pattern).render(0, grid="a")),
            (usage, "'frames' is of turntables", lambda: freevoxels.Sequence(pattern).render(0, frames=3)),
            (usage, "is a sequence of volumes", lambda: freevoxels.Volume.open(pattern)),
            (usage, "'fixed_view' is an option of sequences", lambda: freevoxels.render(one, fixed_view=True)),
            (usage, "put a run of # into the file name", lambda: freevoxels.render_sequence(pattern, "a.png")),
            (usage, "are the same file", lambda: freevoxels.render_sequence(pattern, 2 * [self.folder / "i_#.png"])),
            (usage, "'images' is missing", lambda: freevoxels.render_sequence(pattern, [])),
            (usage, "standard output", lambda: freevoxels.render_sequence(pattern, "-")),
            (freevoxels.OutputError, "there is no folder", lambda: freevoxels.render_sequence(pattern, "/none/a_##.png")),
        ):
            with self.assertRaises(error, msg=part) as raised:
                work()
            self.assertIn(part, str(raised.exception))


if __name__ == "__main__":
    unittest.main()
