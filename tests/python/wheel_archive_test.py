"""Wheels that apps/python/wheel_archive.py writes are read by others, and keep their files. Usage: wheel_archive_test.py SOURCE_FOLDER"""

import base64
import csv
import hashlib
import io
import pathlib
import sys
import tempfile
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(sys.argv.pop()) / "apps" / "python"))
import wheel_archive

ABOUT = "thing-1.0.dist-info"


class WheelArchiveTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.wheel = pathlib.Path(scratch.name) / "thing.whl"

    def test_files_and_modes_are_kept(self):
        files = {f"{ABOUT}/WHEEL": (b"Wheel-Version: 1.0\n", wheel_archive.DATA), "thing/empty.py": (b"", wheel_archive.DATA),
                 "thing/program": (bytes(range(256)) * 1000, wheel_archive.PROGRAM)}
        wheel_archive.write(self.wheel, files)
        self.assertEqual(wheel_archive.read(self.wheel), files)
        first = self.wheel.read_bytes()
        wheel_archive.write(self.wheel, dict(reversed(files.items())))
        self.assertEqual(self.wheel.read_bytes(), first)

    def test_the_record_has_every_file_and_replaces_that_of_before(self):
        files = {f"{ABOUT}/METADATA": (b"Name: thing\n", wheel_archive.DATA), "thing/data": (b"12345", wheel_archive.DATA)}
        wheel_archive.write(self.wheel, files)
        again = wheel_archive.read(self.wheel)
        again["thing/data"] = (b"1234567", wheel_archive.DATA)
        wheel_archive.write(self.wheel, again)
        with zipfile.ZipFile(self.wheel) as archive:
            rows = list(csv.reader(io.TextIOWrapper(archive.open(f"{ABOUT}/RECORD"), newline="")))
            self.assertEqual(sorted(row[0] for row in rows), sorted(archive.namelist()))
            for name, digest, size in rows:
                if name == f"{ABOUT}/RECORD":
                    continue
                content = archive.read(name)
                expected = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
                self.assertEqual((digest, size), (f"sha256={expected}", str(len(content))), name)


if __name__ == "__main__":
    unittest.main()
