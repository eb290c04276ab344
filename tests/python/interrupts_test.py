"""Ctrl-C while the module works for long, in processes of their own."""

import os
import signal
import subprocess
import sys
import time
import unittest

START = "import numpy as np, freevoxels, logging\nlogging.disable()\nprint('begun', flush=True)\n"
# Each takes ten seconds or more where nothing interrupts it.
WORK = {
    "make a procedural volume": "freevoxels.Volume.open('procedural:cloud', resolution=512)",
    "make a box that is no cube": "freevoxels.Volume.open('procedural:head', resolution=(1800, 1200, 40))",
    "make temperatures": "freevoxels.Volume.open('procedural:fire', resolution=512, emission=True)",
    "read an array": "freevoxels.Volume(np.broadcast_to(np.float32('nan'), (1600, 1600, 1600)))",
    "read a reversed array": "freevoxels.Volume(np.broadcast_to(np.float64('nan'), (1800, 1500, 1700))[::-1, :, ::-1])",
    "draw": "freevoxels.render('procedural:shells', resolution=200, size=(3000, 3000), draw='splats')",
}
LATEST = 5.0  # seconds, on a machine that does other things as well: about 0.2 where it does not


class InterruptsTest(unittest.TestCase):
    def interrupted(self, work, after):
        """Seconds from the interrupt to the exception."""
        code = f"{START}try:\n    {work}\nexcept KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
            try:
                self.assertEqual(child.stdout.readline(), "begun\n")
                time.sleep(after)
                start = time.monotonic()
                os.kill(child.pid, signal.SIGINT)
                self.assertEqual(child.stdout.readline(), "interrupted\n", work)
                return time.monotonic() - start
            finally:
                child.kill()

    def test_long_work_ends_soon(self):
        for name, work in WORK.items():
            for after in (0.7, 2.0):
                with self.subTest(name, after=after):
                    self.assertLess(self.interrupted(work, after), LATEST)


if __name__ == "__main__":
    unittest.main()
