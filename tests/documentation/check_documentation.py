#!/usr/bin/env python3
"""Checks the documentation against the repository and the programs.

    python3 tests/documentation/check_documentation.py ROOT PROGRAM...
    python3 tests/documentation/check_documentation.py --links FOLDER      only the first check, of the pages in a folder

- Every relative link in a *.md file leads to a file, and to a heading of it if the link has an anchor.
- Every file that a page or a comment mentions by its path exists.
- Every command and option of our programs that a *.md file mentions exists in --help.
- Every option in --help is mentioned in the manual.
"""

import pathlib
import re
import subprocess
import sys

OPTION = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")
PATH = re.compile(r"(?<![\w/.-])(?:(?:engine|shaders|apps|tests|third_party_notes)/[\w/.-]+|README)\.(?:h|cpp|glsl|comp|vert|frag|md|py|sh|json|png)\b")
SHADER = re.compile(r"(?<![\w/.*{])[a-z]\w+\.(?:glsl|comp|vert|frag)\b")
SOURCES = {".md", ".h", ".cpp", ".comp", ".vert", ".frag", ".glsl", ".py", ".sh", ".cmake", ".txt"}
FOLDERS = ("engine", "shaders", "apps", "tests", "third_party_notes", ".github")
OPTIONAL_PROGRAMS = {"freevoxels-mpi"}
EVERYWHERE = {"--help", "--version"}


def text_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def options_in(help_text):
    """Names in the left column of --help: "  --size WxH ...", "  --gradient,--no-gradient{false} ...", "  -q,--quiet ..."."""
    return {name for line in re.findall(r"^  (-\S+)", help_text, re.M) for name in OPTION.findall(line)}


def known_options(programs):
    """Options by command: {"freevoxels render": {"--size", ...}, "freevoxels-view": {...}}."""
    known = {}
    for program in programs:
        name, help_text = pathlib.Path(program).name, text_of(program, "--help")
        known[name] = options_in(help_text)
        listed = re.search(r"^Subcommands:\n((?:  .*\n)*)", help_text, re.M)
        for command in re.findall(r"^  ([a-z][a-z-]*) ", listed[1] if listed else "", re.M):
            known[f"{name} {command}"] = options_in(text_of(program, command, "--help"))
    return known


def without_code(text):
    return re.sub(r"`[^`]*`", "", re.sub(r"^ {4,}.*$", "", re.sub(r"```.*?```", "", text, flags=re.S), flags=re.M))


def anchors_of(text):
    """The anchors that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(root, page):
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            yield f"{page.relative_to(root)}: there is no '{target}'"
        elif anchor and anchor not in anchors_of(file.read_text()):
            yield f"{page.relative_to(root)}: '{path or page.name}' has no heading for '#{anchor}'"


def missing_files(root, file):
    """Files of the repository that a comment or page mentions by their path, generated ones (.in) included."""
    for path in PATH.findall(file.read_text(errors="replace")):
        if not any((folder / path).exists() for folder in (root, file.parent)) and not (root / f"{path}.in").exists():
            yield f"{file.relative_to(root)}: there is no '{path}'"
    for shader in SHADER.findall(file.read_text(errors="replace")):
        if not (root / "shaders" / shader).exists():
            yield f"{file.relative_to(root)}: there is no shader '{shader}'"


def code_of(text):
    """Indented lines, with \\ at a line's end joining lines, and code spans."""
    joined = re.sub(r"\\\n\s*", "", text)
    return [line.strip() for line in re.findall(r"^ {4}.*$", joined, re.M)] + re.findall(r"`([^`\n]+)`", re.sub(r"\s*\n\s*", " ", text))


def unknown_options(root, page, known):
    everything = set().union(EVERYWHERE, *known.values())
    text = page.read_text()
    if set(OPTIONAL_PROGRAMS) & set(re.findall(r"freevoxels-\w+", text)) - known.keys():
        return  # nothing is known of the options of a program that was not built
    for code in code_of(text):
        words = code.split()
        if not words or not re.match(r"(freevoxels[\w-]*$|-)", words[0]):
            continue
        command = words[0] if words[0].startswith("freevoxels") else ""
        if command == "freevoxels" and len(words) > 1 and re.fullmatch(r"[a-z][a-z-]*", words[1]):
            command += " " + words[1]
        if " " in command and command not in known:
            yield f"{page.relative_to(root)}: there is no command '{command}'"
        for option in OPTION.findall(re.sub(r"'[^']*'|\"[^\"]*\"", "", code)):
            if option not in known.get(command, everything) | EVERYWHERE:
                yield f"{page.relative_to(root)}: {command or 'no program'} has no option '{option}'"


def unmentioned_options(root, known):
    manual = "\n".join(page.read_text() for page in (root / "apps/manual").glob("*.md") if page.name != "changelog.md")
    mentioned = set(OPTION.findall(manual))
    for command, options in known.items():
        for option in sorted(options - mentioned - EVERYWHERE):
            yield f"apps/manual mentions {option} of '{command}' nowhere"


def check_links(folder):
    pages = sorted(folder.rglob("*.md"))
    problems = [p for page in pages for p in broken_links(folder, page)]
    for problem in problems:
        print(problem)
    print(f"{len(pages)} pages: {len(problems)} problems")
    return 1 if problems or not pages else 0


def main():
    if sys.argv[1] == "--links":
        return check_links(pathlib.Path(sys.argv[2]).resolve())
    root = pathlib.Path(sys.argv[1]).resolve()
    known = known_options(sys.argv[2:])
    files = [root / "README.md"] + sorted(f for folder in FOLDERS for f in (root / folder).rglob("*") if f.is_file())
    pages = [file for file in files if file.suffix == ".md"]
    problems = [p for page in pages for p in broken_links(root, page)]
    problems += [p for file in files if file.suffix in SOURCES for p in missing_files(root, file)]
    problems += [p for page in pages if page.name != "changelog.md" for p in unknown_options(root, page, known)]
    problems += unmentioned_options(root, known)
    for problem in problems:
        print(problem)
    print(f"{len(pages)} pages, {sum(map(len, known.values()))} options of {len(known)} commands: {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
