"""Runs the blocks of apps/manual/python.md as they stand. Usage: manual_test.py SOURCE_FOLDER"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import unittest

PAGE = pathlib.Path(sys.argv.pop()) / "apps" / "manual" / "python.md"


def blocks():
    """The indented blocks of the page that are Python."""
    found = re.findall(r"(?<=\n\n)((?:    .*\n|\n)+)", PAGE.read_text())
    texts = [textwrap.dedent(block) for block in found]
    return [text for text in texts if text.strip() and not re.match(r"\s*(apt-get|python3 -m|PYTHONPATH=)", text)]


class ManualTest(unittest.TestCase):
    def run_in(self, folder, name, text):
        (pathlib.Path(folder) / name).write_text(text)
        ran = subprocess.run([sys.executable, name], cwd=folder, capture_output=True, text=True, env={**os.environ, "PYTHONSAFEPATH": ""})
        self.assertEqual((ran.returncode, ran.stderr), (0, ""), text)
        return ran.stdout

    def test_the_page_is_one_program(self):
        whole = [block for block in blocks() if "multiprocessing" not in block]
        self.assertGreaterEqual(len(whole), 5)
        with tempfile.TemporaryDirectory() as folder:
            printed = self.run_in(folder, "page.py", "\n".join(whole))
            self.assertIn("camera_position", printed)
            self.assertIn("(300, 400, 4)", printed)
            for name in ["image.png", "side.png", "side.json", *(f"turn_{k}.png" for k in range(8)), *(f"step_{k}.png" for k in range(4)),
                         *(f"film_000{k}.{form}" for k in (1, 2, 3) for form in ("png", "exr"))]:
                self.assertTrue((pathlib.Path(folder) / name).exists(), name)

    def test_the_pool_draws(self):
        (pool,) = [block for block in blocks() if "multiprocessing" in block]
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(len(re.findall(r"0\.\d+", self.run_in(folder, "pool.py", pool))), 4)


if __name__ == "__main__":
    unittest.main()
