#!/usr/bin/env python3
"""Checks that the engine leaves to its front ends what is theirs: messages, options, exit codes, signals, the environment.

    engine_is_a_library.py PROJECT_FOLDER
"""
import pathlib
import re
import sys

FORBIDDEN = {
    r"#include <spdlog": "logs: return the text to the caller (Volume::warnings), or call a function of the caller's",
    r"\b(?:std::)?(?:secure_)?getenv\(": "reads the environment: take a parameter",
    r"\b(?:std::)?(?:signal|sigaction|raise)\(": "handles signals",
    r"\b(?:std::)?_?(?:exit|quick_exit|abort)\(": "ends the process: throw an Error or InternalError",
    r"\bExitCode\b": "has exit codes: use ErrorKind",
    r"\brdbuf\(|\bstd::c(?:out|err)\b|\bf?printf\(stdout": "uses the standard streams",
    r'"[^"\n]*(?<![-\w])--[a-z][^"\n]*"': "names an option of the command line: write Parameter(\"name\")",
}
PARAMETER = re.compile(r'\bParameter\("([a-z-]+)"')


def main(root):
    wrong = []
    manual = "\n".join(page.read_text() for page in sorted((root / "apps/manual").glob("*.md")))
    for file in sorted((root / "engine").glob("**/*")):
        name = file.relative_to(root).as_posix()
        if file.suffix not in (".h", ".cpp"):
            continue
        text = file.read_text()
        for pattern, why in FORBIDDEN.items():
            for match in re.finditer(pattern, text):
                wrong.append(f"{name}:{text.count(chr(10), 0, match.start()) + 1}: the engine {why}")
        for parameter in PARAMETER.findall(text):
            if not re.search(rf"--{parameter}(?![\w-])", manual):
                wrong.append(f"{name}: Parameter(\"{parameter}\") is no option in apps/manual")
    print("\n".join(wrong) if wrong else "the engine logs nothing, reads no environment, ends no process and names no options")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
