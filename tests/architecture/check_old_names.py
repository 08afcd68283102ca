#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Fails if a name of tests/old_names.txt appears in code, as a file, or as an option.

Comments and strings are not code. Lines with [[deprecated]] may name what they replace.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = (".hpp", ".cpp", ".cu", ".cuh", ".in", ".py")
NOT_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
# They keep old names alive on purpose.
EXEMPT = ("tests/packaging/consumers/old_names/", "tests/architecture/check_old_names.py")


def main():
    names = [line for line in (ROOT / "tests" / "old_names.txt").read_text().split("\n") if line and not line.startswith("#")]
    pattern = re.compile(rf"\b(?:{'|'.join(map(re.escape, names))})\b")
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    problems = []
    for file in files:
        if file.startswith(EXEMPT):
            continue
        if pattern.search(pathlib.Path(file).stem):
            problems.append(f"{file}: the file has an old name")
        if not file.endswith(SOURCES) or not (ROOT / file).exists():
            continue
        code = NOT_CODE.sub(lambda m: "\n" * m.group().count("\n"), (ROOT / file).read_text())
        for number, line in enumerate(code.split("\n"), 1):
            found = pattern.search(line)
            if found and "deprecated" not in line:
                problems.append(f"{file}:{number}: '{found.group()}' is an old name; see docs/contributing/glossary.md")
    options = (ROOT / "docs" / "reference" / "cli.md").read_text()
    problems += [f"docs/reference/cli.md: the option --{n} has an old name" for n in names if f"--{n.replace('_', '-')} " in options]
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
