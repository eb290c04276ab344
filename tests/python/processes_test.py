"""Processes that are forked or started beside one that draws."""

import multiprocessing
import os
import time
import unittest

import freevoxels
import numpy as np

BOX = np.arange(6 * 7 * 5, dtype="float32").reshape(6, 7, 5) / 210
SMALL = dict(size=(16, 12))
PATIENCE = 120  # seconds


def draw(azimuth):
    return freevoxels.render(BOX, orbit=(azimuth, 20), **SMALL)


def in_fork(work):
    """What `work` returns or raises in a forked process, as text. Fails where it does not end."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            text = str(work())
        except BaseException as error:
            text = f"{type(error).__name__}: {error}"
        os.write(writing, text.encode())
        os._exit(0)
    os.close(writing)
    end = time.monotonic() + PATIENCE
    while os.waitpid(child, os.WNOHANG)[0] == 0:
        if time.monotonic() > end:
            os.kill(child, 9)
            os.waitpid(child, 0)
            raise AssertionError("the forked process does not end")
        time.sleep(0.02)
    with os.fdopen(reading) as pipe:
        return pipe.read()


class ForkTest(unittest.TestCase):
    def test_a_fork_before_the_first_image_draws(self):
        # In a process of its own, as others of this file have drawn.
        context = multiprocessing.get_context("spawn")
        with context.Pool(1) as pool:
            self.assertIn("(12, 16, 4)", pool.apply(fork_first))

    def test_a_fork_after_an_image_fails_at_once_and_names_spawn(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(BOX), **SMALL)
        renderer.render()
        frames = renderer.turntable(3)
        for work in (lambda: draw(0), lambda: renderer.render(), lambda: next(frames),
                     lambda: freevoxels.render("procedural:cube", resolution=8), lambda: freevoxels.Renderer(freevoxels.Volume(BOX))):
            self.assertRegex(in_fork(work), "DeviceError: this process was forked .* 'spawn'")
        self.assertEqual(renderer.render().shape, (12, 16, 4))

    def test_what_needs_no_device_works_in_a_fork(self):
        draw(0)
        self.assertEqual(in_fork(lambda: freevoxels.Volume(BOX).shape), "(6, 7, 5)")
        self.assertEqual(in_fork(lambda: freevoxels.Volume.open("procedural:cube", resolution=8).shape), "(8, 8, 8)")
        self.assertEqual(in_fork(lambda: freevoxels.save("/dev/null/x.png", np.zeros((2, 2, 4))) or "").split(":")[0], "OutputError")

    def test_renderers_may_be_freed_in_a_fork(self):
        renderers = [freevoxels.Renderer(freevoxels.Volume(BOX), **SMALL)]
        renderers[0].render()

        def free():
            renderers.clear()
            return "freed"

        self.assertEqual(in_fork(free), "freed")

    def test_pools_that_fork_raise_and_pools_that_spawn_draw(self):
        expected = [draw(azimuth) for azimuth in (0, 90)]
        with multiprocessing.get_context("fork").Pool(2) as pool:
            with self.assertRaisesRegex(freevoxels.DeviceError, "spawn"):
                pool.map_async(draw, (0, 90)).get(PATIENCE)
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            np.testing.assert_array_equal(pool.map_async(draw, (0, 90)).get(PATIENCE), expected)


def fork_first():
    return in_fork(lambda: draw(0).shape)


if __name__ == "__main__":
    unittest.main()
