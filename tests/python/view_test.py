"""The view of a renderer: turntables, cameras that can be read, and frames between which neither size nor light change."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import freevoxels
import numpy as np

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]
LONG = np.ones((6, 9, 30), "float32")  # seen from the side much wider than from its end


def distance(camera):
    return float(np.linalg.norm(np.subtract(camera["camera_position"], camera["look_at"])))


class TurntableTest(unittest.TestCase):
    def test_frames_are_those_of_the_command_line(self):
        with tempfile.TemporaryDirectory() as folder:
            for source, resolution, view in (("procedural:cloud", "20", {}), ("procedural:shells", "24x16x12", {"orbit": "80,10"})):
                options = {"size": "48x40", **view}
                flags = [f"--{key}={value}" for key, value in {"resolution": resolution, **options}.items()]
                made = subprocess.run([PROGRAM, "turntable", source, f"{folder}/cli_#.png", "--frames", "5", *flags], capture_output=True,
                                      text=True)
                self.assertEqual(made.returncode, 0, made.stderr)
                renderer = freevoxels.Renderer(freevoxels.Volume.open(source, resolution=resolution), **options)
                frames = renderer.turntable(5)
                self.assertEqual(len(frames), 5)
                for number, image in enumerate(frames):
                    freevoxels.save(f"{folder}/py.png", image)
                    files = sorted(pathlib.Path(folder).glob("cli_*.png"))
                    self.assertEqual(pathlib.Path(f"{folder}/py.png").read_bytes(), files[number].read_bytes(), (source, number))
                self.assertEqual(number, 4)
                self.assertEqual(len(frames), 0)

    def test_a_flight_is_that_of_the_command_line(self):
        flight = {"keys": [{"time": 0, "camera_position": (1, 1, 2), "look_at": np.zeros(3), "fov": 30, "light": {"direction": (1, 1, 1)}},
                           {"time": 1.5, "camera_position": (-1, 0, 2), "look_at": (0, 0.1, 0), "light": {"direction": (-1, 1, 1)}}]}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "flight.json"
            file.write_text(json.dumps(flight, default=np.ndarray.tolist))
            made = subprocess.run([PROGRAM, "turntable", "procedural:cloud", f"{folder}/cli_#.png", "--frames=3", "--resolution=20", "--size=48x40",
                                   f"--flight={file}"], capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stderr)
            volume = freevoxels.Volume.open("procedural:cloud", resolution=20)
            of_renderer = freevoxels.Renderer(volume, size=(48, 40), flight=flight).turntable(3)
            of_turn = freevoxels.Renderer(volume, size=(48, 40)).turntable(3, flight=file)
            for number, (one, other) in enumerate(zip(of_renderer, of_turn)):
                np.testing.assert_array_equal(one, other)
                freevoxels.save(f"{folder}/py.png", one)
                self.assertEqual((pathlib.Path(folder) / "py.png").read_bytes(), (pathlib.Path(folder) / f"cli_{number}.png").read_bytes(), number)
            self.assertEqual(number, 2)

    def test_frames_of_a_turntable_are_of_the_flight_that_the_first_of_them_has_read(self):
        flight = {"keys": [{"time": 0, "camera_position": (1, 1, 2), "look_at": (0, 0, 0), "light": {"direction": (1, 1, 1)}},
                           {"time": 1, "camera_position": (-1, 0, 2), "look_at": (0, 0, 0), "light": {"direction": (-1, 1, 1)}}]}
        changed = {"keys": [flight["keys"][0], {**flight["keys"][1], "camera_position": (2, 1, -1)}]}
        renderer = freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=20), size=(48, 40))
        expected = list(renderer.turntable(3, flight=flight))
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "flight.json"
            file.write_text(json.dumps(flight))
            turn = renderer.turntable(3, flight=file)
            images = [next(turn)]
            file.write_text(json.dumps(changed))
            np.testing.assert_array_equal(list(renderer.turntable(3, flight=file)), list(renderer.turntable(3, flight=changed)))
            images.append(next(turn))
            file.unlink()
            images.append(next(turn))
            np.testing.assert_array_equal(images, expected)
            with self.assertRaisesRegex(freevoxels.InputError, "flight.json"):
                renderer.turntable(3, flight=file)

    def test_distance_is_the_same_for_all_frames(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(LONG), size=(64, 48))
        distances = []
        for image, depth in renderer.turntable(6, depth=True, density_scale=1):
            self.assertEqual((image.shape, depth.shape), ((48, 64, 4), (48, 64)))
            distances.append(distance(renderer.camera))
        np.testing.assert_allclose(distances, distances[0])

    def test_wrong_numbers_of_frames_are_named(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(LONG), size=(16, 12))
        for frames in (0, -1, 10**9, 2.5, "many", None):
            with self.assertRaisesRegex(freevoxels.Error, "'frames'"):
                renderer.turntable(frames)
        with self.assertRaisesRegex(freevoxels.UsageError, "'frames' is of turntables"):
            renderer.render(frames=12)


class FixedViewTest(unittest.TestCase):
    def test_distance_and_look_at_point_stay_while_the_orbit_changes(self):
        for array, options in ((LONG, {}), (LONG, {"orbit": (80, 5)}), (LONG.T, {"orthographic": 40}), (LONG, {"up": (0, 0, 1)}),
                               (LONG, {"camera_position": (100, 20, 9), "look_at": (15, 4, 3)})):
            renderer = freevoxels.Renderer(freevoxels.Volume(np.ascontiguousarray(array)), size=(40, 30), **options)
            renderer.render(**({"orbit": (3, 4)} if "camera_position" in options else {}))  # which replaces the position
            first = renderer.camera
            for azimuth in range(0, 360, 60):
                renderer.render(orbit=(azimuth, 20))
                self.assertAlmostEqual(distance(renderer.camera), distance(first), places=6)
                np.testing.assert_allclose(renderer.camera["look_at"], first["look_at"])
            renderer.render()
            if "camera_position" in options:
                first = {**first, **options}
            self.assertEqual(renderer.camera, first)

    def test_an_orbit_is_at_its_angles(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(LONG), size=(40, 30))
        for (azimuth, elevation), towards in (((0, 0), (0, 0, 1)), ((90, 0), (1, 0, 0)), ((180, 0), (0, 0, -1)), ((0, 45), (0, 2**-0.5, 2**-0.5)),
                                              ((0, 90), (0, 1, 0))):
            renderer.render(orbit=(azimuth, elevation))
            offset = np.subtract(renderer.camera["camera_position"], renderer.camera["look_at"])
            np.testing.assert_allclose(offset / np.linalg.norm(offset), towards, atol=1e-9)

    def test_default_light_does_not_turn_and_its_rays_are_kept(self):
        renderer = freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=24), size=(48, 40))
        renderer.render()
        first = {stage for stage, _ in renderer.timings}
        for azimuth in (60, 120):
            renderer.render(orbit=(azimuth, 25))
            again = {stage for stage, _ in renderer.timings}
            self.assertFalse({stage for stage in again if "light" in stage and "sweep" in stage}, again)
        self.assertTrue(first - again)

    def test_the_camera_that_is_read_draws_the_same_frame(self):
        light = {"direction": (1, 1, 1)}
        for options in ({}, {"orthographic": 30}, {"fov": 50}):
            renderer = freevoxels.Renderer(freevoxels.Volume(LONG), size=(40, 30), light=light, ambient=0.2, **options)
            self.assertIsNone(renderer.camera)
            image = renderer.render(orbit=(120, -10))
            np.testing.assert_array_equal(freevoxels.render(LONG, light=light, ambient=0.2, **renderer.camera), image)
            self.assertEqual(renderer.camera["size"], (40, 30))

    def test_the_order_of_frames_does_not_matter(self):
        volume = freevoxels.Volume.open("procedural:cloud", resolution=20)
        one, other = (freevoxels.Renderer(volume, size=(40, 30)) for _ in range(2))
        orbits = [(0, 10), (90, 20), (200, -30)]
        images = [one.render(orbit=orbit) for orbit in orbits]
        for orbit, image in reversed(list(zip(orbits, images))):
            np.testing.assert_array_equal(other.render(orbit=orbit), image)


class ProgressTest(unittest.TestCase):
    def test_fractions_never_decrease_and_end_at_1(self):
        for options in ({"draw": "splats"}, {"draw": "gather"}):
            renderer = freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=(61, 40, 33)), size=(700, 600), **options)
            for more in ({}, {"orbit": (90, 8)}, {"size": (16, 12)}, {"unlit": True}):
                fractions = []
                renderer.render(progress=lambda stage, fraction: fractions.append(fraction), **more)
                self.assertEqual(fractions, sorted(fractions))
                self.assertEqual(fractions[-1], 1)
                self.assertEqual(fractions.count(1), 1)

    def test_what_is_no_function_is_refused_whatever_the_frame(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(LONG), size=(16, 12))
        for call in (renderer.render, lambda **more: freevoxels.render(LONG, size=(16, 12), **more), lambda **more: renderer.turntable(2, **more)):
            with self.assertRaisesRegex(freevoxels.UsageError, "'progress' takes a function of a stage and a fraction, not int"):
                call(progress=5)

    def test_drafts_have_all_pixels_and_follow_their_budget(self):
        renderer = freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=32), size=(96, 80), unlit=True)
        whole = renderer.render()
        np.testing.assert_array_equal(renderer.render(budget=1e-6), renderer.render(quality=0.05))
        self.assertFalse(np.array_equal(renderer.render(budget=1e-6), whole))
        drafts = (renderer.render(budget=1e9) for _ in range(40))
        self.assertTrue(any(np.array_equal(draft, whole) for draft in drafts))
        for wrong in (0, -1, "soon"):
            with self.assertRaisesRegex(freevoxels.UsageError, "'budget'"):
                renderer.render(budget=wrong)

    def test_timings_are_of_the_frame_alone(self):
        renderer = freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=40), size=(48, 40))
        renderer.render()
        first = renderer.timings
        renderer.render()
        again = renderer.timings
        self.assertTrue(again)
        self.assertLess({stage for stage, _ in again}, {stage for stage, _ in first})


if __name__ == "__main__":
    unittest.main()
