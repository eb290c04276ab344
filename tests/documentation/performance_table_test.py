"""performance_table.py writes the figures of freevoxels-bench into a Markdown file and keeps those of other devices."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "apps/bench/performance_table.py"


class PerformanceTableTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.page = self.folder / "page.md"
        self.page.write_text("before\n<!-- freevoxels-bench: begin -->\n<!-- freevoxels-bench: end -->\nafter\n")

    def bench(self, device, milliseconds):
        path = self.folder / f"{device}.json"
        path.write_text(json.dumps({"device": device, "driver": "1", "version": "2", "stages": [
            {"stage": "sweeps", "milliseconds": milliseconds, "ratio_to_copy": 25.04},
            {"stage": "list", "milliseconds": 1.2345, "items_per_second": 3e6}]}))
        return path

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)

    def test_figures_of_a_device_replace_those_that_it_had_and_no_others(self):
        self.assertEqual(self.run_script(self.page, self.bench("one", 100.4), self.bench("two", 7.0)).returncode, 0)
        first = self.page.read_text()
        self.assertTrue(first.startswith("before\n") and first.endswith("after\n"))
        self.assertIn("### one\n\nDriver 1, FreeVoxels 2.\n", first)
        self.assertIn("| sweeps | 100 | 25.0 |  |", first)
        self.assertIn("| list | 1.23 |  | 3.00 |", first)
        self.assertEqual(self.run_script(self.page, self.bench("one", 90.0)).returncode, 0)
        self.assertEqual(self.page.read_text(), first.replace("| sweeps | 100 |", "| sweeps | 90 |"))

    def test_what_cannot_be_read_is_named_and_nothing_changes(self):
        (self.folder / "no.json").write_text("[]")
        (self.folder / "bare.md").write_text("nothing")
        before = self.page.read_text()
        for arguments, names in [([self.page, self.folder / "no.json"], "no.json"), ([self.page, self.folder / "none.json"], "none.json"),
                                 ([self.folder / "bare.md", self.bench("one", 1.0)], "bare.md")]:
            result = self.run_script(*arguments)
            self.assertEqual(result.returncode, 1)
            self.assertIn(names, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1)
        self.assertEqual(self.page.read_text(), before)


if __name__ == "__main__":
    unittest.main()
