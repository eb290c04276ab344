"""apps/validate/draw_report.py: the page and the plot of figures in JSON."""

import html.parser
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ET

SCRIPT = pathlib.Path(__file__).parents[2] / "apps" / "validate" / "draw_report.py"
HOSTILE = "a<b & \"c\" 'd' </script>"


def check(name, passed, figure, bound, tolerance):
    return {"name": name, "passed": passed, "figure": figure, "bound": bound, "tolerance": tolerance, "unit": "dB", "where": "pixel 7,8"}


REPORT = {
    "passed": False,
    "facts": {"device": "llvmpipe", "volume": HOSTILE},
    "sections": [
        {
            "title": HOSTILE, "passed": False, "text": "First.\n\nSecond.",
            "checks": [check("by a hair", False, 1.0000001, "at most", 1.0), check("equal images", True, "Infinity", "at least", 65),
                       check(HOSTILE, False, "NaN", "at most", 0.1)],
            "tables": [{"caption": "By direction", "columns": ["direction", "largest"], "rows": [[HOSTILE, "0.5"], ["+x", "12"]]}],
            "plots": [{"caption": "Error", "x_label": "resolution", "y_label": HOSTILE,
                       "series": [{"name": "ours", "points": [[0, 0], [1, 1], [2, "NaN"], [3, 2], [10, 4]]}, {"name": HOSTILE, "points": [[0, -1e-7]]}]},
                      {"caption": "Nothing", "x_label": "x", "y_label": "y", "series": [{"name": "s", "points": []}]},
                      {"caption": "One", "x_label": "x", "y_label": "y", "series": [{"name": "s", "points": [[5, 7]]}]}],
            "image_rows": [{"caption": "Row", "images": [{"caption": HOSTILE, "width": 5, "height": 4, "png": "iVBORw0KGgo="}]}],
        }
    ],
}


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.words, self.open = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_data(self, data):
        self.words.append(data)


class DrawReportTest(unittest.TestCase):
    def drawn(self, name, report=REPORT, fails=False):
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder) / "report.json", pathlib.Path(folder) / name
            source.write_text(json.dumps(report))
            done = subprocess.run([sys.executable, SCRIPT, source, str(target)], capture_output=True, text=True)
            self.assertEqual(done.returncode != 0, fails, done.stderr)
            return done.stderr if fails else target.read_text()

    def test_page_has_everything_as_it_is_written(self):
        page = Page(self.drawn("report.html"))
        for word in ("2 of 3 checks failed", "llvmpipe", "First.\n\nSecond.", "1.0000001", "≤ 1", "∞", "≥ 65", "NaN", "By direction", "Row"):
            self.assertIn(word, page.words)
        self.assertGreaterEqual(page.words.count(HOSTILE), 6)
        self.assertEqual([tag for tag, _ in page.tags if tag in ("script", "link", "b")], [])

    def test_page_needs_no_other_file(self):
        page = Page(self.drawn("report.html"))
        for _, attributes in page.tags:
            for name in ("src", "href"):
                self.assertTrue(attributes.get(name, "#").startswith(("#", "data:image/png;base64,")), attributes)

    def test_every_link_has_its_target(self):
        page = Page(self.drawn("report.html"))
        targets = [attributes["id"] for _, attributes in page.tags if "id" in attributes]
        links = [attributes["href"][1:] for _, attributes in page.tags if "href" in attributes]
        self.assertEqual(len(links), 3)
        for link in links:
            self.assertEqual(targets.count(link), 1, link)

    def test_plot_draws_every_point_and_breaks_lines_where_there_is_none(self):
        text = self.drawn("plot.svg")
        svg = ET.fromstring(text)
        self.assertTrue(svg.tag.endswith("svg"))
        self.assertEqual(sum(one.tag.endswith("circle") for one in svg.iter()), 5)
        self.assertIn('d="M84.00,', text)
        self.assertNotIn("nan", text)
        self.assertEqual(sum(one.text == HOSTILE for one in svg.iter()), 2)

    def test_empty_reports(self):
        empty = {"passed": True, "facts": {}, "sections": []}
        self.assertIn("no checks", self.drawn("a.html", empty))
        self.assertIn("has no plot", self.drawn("a.svg", empty, fails=True))


if __name__ == "__main__":
    unittest.main()
