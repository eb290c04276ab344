#!/usr/bin/env python3
"""Writes the figures of freevoxels-bench --json into a Markdown file.

    performance_table.py FILE.md BENCH.json...

A table for each device replaces what is between the two lines that hold the comments
"freevoxels-bench: begin" and "freevoxels-bench: end"; devices of which no figures are given keep theirs.
"""
import json
import os
import re
import sys
import tempfile

BEGIN, END = "<!-- freevoxels-bench: begin -->", "<!-- freevoxels-bench: end -->"


def table(figures):
    """The Markdown of one device, which begins with its heading."""
    lines = [f"### {figures['device']}", "", f"Driver {figures['driver']}, FreeVoxels {figures['version']}.", "",
             "| stage | ms | × copy | million/s |", "| --- | --- | --- | --- |"]
    for stage in figures["stages"]:
        milliseconds = stage["milliseconds"]
        ratio = f"{stage['ratio_to_copy']:.1f}" if "ratio_to_copy" in stage else ""
        rate = f"{stage['items_per_second'] * 1e-6:.2f}" if "items_per_second" in stage else ""
        lines.append(f"| {stage['stage']} | {milliseconds:.{2 if milliseconds < 10 else 0}f} | {ratio} | {rate} |")
    return "\n".join(lines) + "\n"


def sections(text):
    """The tables that are there, by heading."""
    found = re.split(r"(?m)^(?=### )", text)
    return {section.split("\n", 1)[0]: section.strip() + "\n" for section in found if section.startswith("### ")}


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__.strip())
    path, *files = arguments
    try:
        with open(path, encoding="utf-8") as file:
            text = file.read()
        begin, end = text.index(BEGIN) + len(BEGIN), text.index(END)
    except OSError as error:
        sys.exit(f"performance_table.py: cannot read '{path}': {error.strerror}")
    except ValueError:
        sys.exit(f"performance_table.py: '{path}' has no lines '{BEGIN}' and '{END}' to write between")
    tables = sections(text[begin:end])
    for name in files:
        try:
            with open(name, encoding="utf-8") as file:
                made = table(json.load(file))
        except OSError as error:
            sys.exit(f"performance_table.py: cannot read '{name}': {error.strerror}")
        except (ValueError, KeyError, TypeError):
            sys.exit(f"performance_table.py: '{name}' is not what freevoxels-bench --json writes")
        tables[made.split("\n", 1)[0]] = made
    result = text[:begin] + "\n\n" + "\n".join(tables.values()) + "\n" + text[end:]
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=os.path.dirname(os.path.abspath(path)), delete=False) as file:
        file.write(result)
    os.chmod(file.name, os.stat(path).st_mode)
    os.replace(file.name, path)


if __name__ == "__main__":
    main(sys.argv[1:])
