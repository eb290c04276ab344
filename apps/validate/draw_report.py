#!/usr/bin/env python3
"""Draws the figures that freevoxels-validate and freevoxels-bench --cluster write with --json.

    draw_report.py FILE.json OUT.html   the report as one page, which needs no other file
    draw_report.py FILE.json OUT.svg    its first plot
"""
import json
import math
import pathlib
import sys
import xml.etree.ElementTree as ET

STYLE = """
:root { --ink: #1c2126; --quiet: #66707a; --line: #d5dade; --pass: #1b6e3c; --fail: #b3261e; }
body { margin: 0; color: var(--ink); font: 15px/1.5 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 2.5rem 1.5rem 4rem; }
h2 { margin: 2.6rem 0 .7rem; padding-bottom: .3rem; border-bottom: 1px solid var(--line); font-size: 1.2rem; }
a { color: inherit; text-underline-offset: .2em; }
.pass { color: var(--pass); }
.fail { color: var(--fail); font-weight: 700; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1.2rem; font-size: .85rem; }
dt, caption, figcaption { color: var(--quiet); }
dd { margin: 0; overflow-wrap: anywhere; }
.text { max-width: 44rem; white-space: pre-line; }
table { width: 100%; margin: 1.2rem 0; border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
caption { caption-side: bottom; padding-top: .5rem; text-align: left; }
th, td { padding: .35rem .8rem .35rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); font-weight: 400; }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1.6rem 0; break-inside: avoid; }
figcaption { margin-top: .5rem; font-size: .85rem; }
.images { display: flex; flex-wrap: wrap; gap: 1rem; }
.images figure { flex: 1 1 12rem; margin: 0; }
img { display: block; max-width: 100%; height: auto; }
.small { image-rendering: pixelated; }
svg { display: block; width: 100%; max-width: 720px; }
"""
SMALL_IMAGE = 256  # smaller images are shown at whole multiples of their size, so that their pixels are visible

WIDTH, LEFT, RIGHT, TOP, BOTTOM = 720, 84, 704, 14, 314  # of a plot, about pixels
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("", "7 4", "2 3")  # change with every seven series, when the colours repeat
MOST_MARKS = 64              # more points are a line alone


def add(parent, tag, text=None, **attributes):
    """Adds an element. `class_` is the attribute class, and _ in the name of an attribute is -."""
    element = ET.SubElement(parent, tag, {name.rstrip("_").replace("_", "-"): str(value) for name, value in attributes.items()})
    element.text = text
    return element


def figure(value, digits=4):
    if isinstance(value, str):  # "NaN", "Infinity", "-Infinity"
        return {"Infinity": "∞", "-Infinity": "−∞"}.get(value, value)
    if value == int(value) and abs(value) < 1e15:
        return f"{value:.0f}".replace("-", "−")
    return f"{value:.{digits}g}".replace("-", "−")


def figure_beside(value, other):
    """With as many digits as tell the two apart: a figure that just misses its bound must not look as if it met it."""
    digits = 4
    while value != other and figure(value, digits) == figure(other, digits) and digits < 17:
        digits += 1
    return figure(value, digits)


def bound(check):
    return ("≤ " if check["bound"] == "at most" else "≥ ") + figure_beside(check["tolerance"], check["figure"])


def verdict(checks):
    failed = sum(not check["passed"] for check in checks)
    if not checks:
        return "no checks"
    return f"{failed} of {len(checks)} checks failed" if failed else f"all {len(checks)} checks passed"


def is_number(text):
    try:
        float(text.split()[0].rstrip("%"))
        return True
    except (ValueError, IndexError):
        return False


def table(parent, columns, rows, caption=None, numeric=None):
    numeric = numeric or [bool(rows) and all(is_number(row[i]) for row in rows) for i in range(len(columns))]
    of = [{"class_": "number"} if number and i > 0 else {} for i, number in enumerate(numeric)]
    made = add(parent, "table")
    if caption:
        add(made, "caption", caption)
    head, body = add(add(made, "thead"), "tr"), add(made, "tbody")
    for column, attributes in zip(columns, of):
        add(head, "th", column, **attributes)
    for row in rows:
        line = add(body, "tr")
        for cell, attributes in zip(row, of):
            add(line, "td", cell, **attributes)
    return body


def checks_table(parent, checks, section):
    rows = [[check["name"], "pass" if check["passed"] else "FAIL", figure_beside(check["figure"], check["tolerance"]), bound(check),
             check["unit"], check["where"]] for check in checks]
    body = table(parent, ["Check", "Verdict", "Figure", "Bound", "Unit", "Where"], rows, numeric=[False, False, True, True, False, False])
    for number, (line, check) in enumerate(zip(body, checks), 1):
        line.set("id", f"check-{section}-{number}")
        line[1].set("class", "pass" if check["passed"] else "fail")


def ticks(values, count):
    """The step and the range of an axis, in steps: round numbers around all values."""
    low, high = min(values, default=0.0), max(values, default=1.0)
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        room = 0.1 * abs(high) or 1.0
        low, high = low - room, high + room
    power = 10.0 ** math.floor(math.log10((high - low) / count))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power * count >= (high - low) * (1 - 1e-9))
    return step, math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)


def plot(parent, shown):
    series = [(one["name"], [point if all(isinstance(v, (int, float)) and abs(v) < 1e300 for v in point) else None for point in one["points"]])
              for one in shown["series"]]
    points = [point for _, some in series for point in some if point]
    (x_step, x_low, x_high), (y_step, y_low, y_high) = (ticks([point[axis] for point in points], count) for axis, count in ((0, 8), (1, 6)))

    def place(point):
        x, y = (point[0] / x_step - x_low) / (x_high - x_low), (point[1] / y_step - y_low) / (y_high - y_low)
        return f"{LEFT + (RIGHT - LEFT) * x:.2f},{BOTTOM - (BOTTOM - TOP) * y:.2f}"

    rows = len(series) if len(series) > 1 else 0
    height = BOTTOM + 56 + 20 * rows
    svg = add(parent, "svg", viewBox=f"0 0 {WIDTH} {height}", role="img", aria_label=shown["caption"], font_size=12, font_family="sans-serif",
              fill="#1c2126", xmlns="http://www.w3.org/2000/svg")
    add(svg, "rect", width=WIDTH, height=height, fill="#fff")
    for i in range(x_low, x_high + 1):
        x = place((i * x_step, y_low * y_step)).split(",")[0]
        add(svg, "path", d=f"M{x},{TOP}V{BOTTOM}", stroke="#e6eaed")
        add(svg, "text", figure(i * x_step), x=x, y=BOTTOM + 18, text_anchor="middle")
    for i in range(y_low, y_high + 1):
        y = float(place((x_low * x_step, i * y_step)).split(",")[1])
        add(svg, "path", d=f"M{LEFT},{y}H{RIGHT}", stroke="#e6eaed")
        add(svg, "text", figure(i * y_step), x=LEFT - 8, y=y + 4, text_anchor="end")
    add(svg, "path", d=f"M{LEFT},{TOP}V{BOTTOM}H{RIGHT}", fill="none", stroke="#1c2126")
    add(svg, "text", shown["x_label"], x=(LEFT + RIGHT) / 2, y=BOTTOM + 40, text_anchor="middle")
    add(svg, "text", shown["y_label"], transform=f"translate(18,{(TOP + BOTTOM) / 2}) rotate(-90)", text_anchor="middle")
    for number, (name, some) in enumerate(series):
        look = {"fill": "none", "stroke": COLORS[number % len(COLORS)], "stroke_width": 1.8,
                "stroke_dasharray": DASHES[number // len(COLORS) % len(DASHES)]}
        line = "".join(("L" if i > 0 and some[i - 1] else "M") + place(point) for i, point in enumerate(some) if point)
        add(svg, "path", d=line or "M0,0", **look)
        for point in some if len(some) <= MOST_MARKS else ():
            if point:
                x, y = place(point).split(",")
                add(svg, "circle", cx=x, cy=y, r=3, fill=look["stroke"])
        if rows:
            y = BOTTOM + 62 + 20 * number
            add(svg, "path", d=f"M{LEFT},{y}h28", **look)
            add(svg, "text", name, x=LEFT + 36, y=y + 4)


def image_row(parent, row):
    made = add(parent, "figure")
    images = add(made, "div", class_="images")
    for shown in row["images"]:
        scale = max(1, SMALL_IMAGE // max(shown["width"], shown["height"], 1))
        one = add(images, "figure", style=f"max-width: max(8rem, {scale * shown['width']}px)")
        add(one, "img", src="data:image/png;base64," + shown["png"], alt=shown["caption"], width=scale * shown["width"],
            height=scale * shown["height"], class_="small" if scale > 1 else "")
        add(one, "figcaption", shown["caption"])
    add(made, "figcaption", row["caption"])


def page(report):
    html = ET.Element("html", lang="en")
    head, main = add(html, "head"), add(add(html, "body"), "main")
    add(head, "meta", charset="utf-8")
    add(head, "title", "FreeVoxels validation report")
    add(head, "style", STYLE)
    add(main, "h1", "FreeVoxels validation report")
    sections = report["sections"]
    add(main, "p", verdict([check for section in sections for check in section["checks"]]), class_="pass" if report["passed"] else "fail")
    facts = add(main, "dl")
    for name, value in report["facts"].items():
        add(facts, "dt", name)
        add(facts, "dd", value)
    failures, contents = add(main, "ul"), add(main, "ol")
    for number, section in enumerate(sections, 1):
        entry = add(contents, "li")
        add(entry, "a", section["title"], href=f"#section-{number}").tail = f" {verdict(section['checks'])}"
        made = add(main, "section", id=f"section-{number}")
        add(made, "h2", f"{number}. {section['title']}")
        add(made, "p", section["text"], class_="text")
        if section["checks"]:
            checks_table(made, section["checks"], number)
        for place, check in enumerate(section["checks"], 1):
            if not check["passed"]:
                add(add(failures, "li"), "a", f"{section['title']}: {check['name']}", href=f"#check-{number}-{place}", class_="fail")
        for one in section["tables"]:
            table(made, one["columns"], one["rows"], one["caption"])
        for one in section["plots"]:
            drawn = add(made, "figure")
            plot(drawn, one)
            add(drawn, "figcaption", one["caption"])
        for row in section["image_rows"]:
            image_row(made, row)
    return "<!DOCTYPE html>\n" + ET.tostring(html, encoding="unicode", method="html") + "\n"


def main(source, target):
    report = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))
    if target.endswith(".svg"):
        plots = [one for section in report["sections"] for one in section["plots"]]
        if not plots:
            sys.exit(f"{source} has no plot: write it with freevoxels-bench --cluster, or draw an .html")
        drawing = ET.Element("drawing")
        plot(drawing, plots[0])
        text = ET.tostring(drawing[0], encoding="unicode") + "\n"
    else:
        text = page(report)
    pathlib.Path(target).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
