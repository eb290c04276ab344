"""What functions of the caller may do that the module calls: progress, and handlers of its logger."""

import logging
import threading
import unittest

import freevoxels
import numpy as np

SLOW = dict(size=(900, 900), draw="splats")  # long enough to be reported
QUICK = dict(size=(40, 32))


def volume():
    return freevoxels.Volume.open("procedural:cloud", resolution=(61, 40, 33))


class Once:
    """A progress function that calls `work` once, and keeps what it returned."""

    def __init__(self, work):
        self.work, self.calls, self.result = work, 0, None

    def __call__(self, stage, fraction):
        self.calls += 1
        if self.calls == 1:
            self.result = self.work()


class ProgressTest(unittest.TestCase):
    def during_a_frame(self, renderer, work):
        once = Once(work)
        renderer.render(progress=once, **SLOW)
        self.assertGreater(once.calls, 0)
        return once.result

    def test_timings_are_those_of_the_last_complete_frame(self):
        renderer = freevoxels.Renderer(volume())
        self.assertEqual(self.during_a_frame(renderer, lambda: renderer.timings), [])
        before = renderer.timings
        self.assertTrue(before)
        self.assertEqual(self.during_a_frame(renderer, lambda: renderer.timings), before)

    def test_another_renderer_draws(self):
        renderer, second = freevoxels.Renderer(volume()), freevoxels.Renderer(volume())
        expected = freevoxels.render(volume(), **QUICK)
        np.testing.assert_array_equal(self.during_a_frame(renderer, lambda: second.render(**QUICK)), expected)
        np.testing.assert_array_equal(self.during_a_frame(renderer, lambda: freevoxels.render(volume(), **QUICK)), expected)
        np.testing.assert_array_equal(renderer.render(**QUICK), expected)

    def test_everything_else_works(self):
        renderer = freevoxels.Renderer(volume())
        self.assertEqual(self.during_a_frame(renderer, lambda: renderer.device), renderer.device)
        self.assertEqual(self.during_a_frame(renderer, lambda: freevoxels.Volume(np.ones((3, 4, 5))).shape), (3, 4, 5))
        other = freevoxels.Renderer(volume(), memory_limit=2000)  # on a device of its own
        self.assertEqual(self.during_a_frame(renderer, lambda: other.render(**QUICK)).shape, (32, 40, 4))

    def test_the_renderer_itself_refuses(self):
        renderer, second = freevoxels.Renderer(volume()), freevoxels.Renderer(volume())

        def refused():
            with self.assertRaisesRegex(freevoxels.UsageError, "cannot draw a frame in the progress function of another of its frames"):
                renderer.render(**QUICK)

        self.during_a_frame(renderer, refused)
        self.during_a_frame(renderer, lambda: self.during_a_frame(second, refused))
        self.assertEqual(renderer.render(**QUICK).shape, (32, 40, 4))

    def test_a_refusal_that_is_not_caught_abandons_the_frame(self):
        renderer = freevoxels.Renderer(volume())
        with self.assertRaises(freevoxels.UsageError):
            renderer.render(progress=lambda stage, fraction: renderer.render(**QUICK), **SLOW)
        self.assertEqual(renderer.timings, [])
        self.assertEqual(renderer.render(**QUICK).shape, (32, 40, 4))

    def test_other_threads_draw_afterwards(self):
        renderer, second = freevoxels.Renderer(volume()), freevoxels.Renderer(volume())
        images = []
        thread = threading.Thread(target=lambda: images.append(second.render(**QUICK)))
        self.during_a_frame(renderer, thread.start)
        thread.join()
        np.testing.assert_array_equal(images[0], renderer.render(**QUICK))


class LoggingTest(unittest.TestCase):
    def test_a_handler_may_draw(self):
        images = []

        class Handler(logging.Handler):
            def emit(self, record):
                images.append(freevoxels.render(volume(), **QUICK))

        logger, handler = logging.getLogger("freevoxels"), Handler()
        logger.addHandler(handler)
        self.addCleanup(logger.removeHandler, handler)
        infinite = np.ones((5, 6, 7))
        infinite[1, 2, 3] = np.inf
        freevoxels.Volume(infinite)
        self.assertEqual([image.shape for image in images], [(32, 40, 4)])


if __name__ == "__main__":
    unittest.main()
