#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Fails if a Markdown page links to a file that does not exist, or if no page links to a page of docs/."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


def main():
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    pages = [ROOT / name for name in listed.split("\n") if name and (ROOT / name).exists()]
    problems, linked = [], set()
    for page in pages:
        for target in LINK.findall(page.read_text()):
            if re.match(r"[a-z]+:", target):
                continue
            file = (page.parent / target).resolve()
            linked.add(file)
            if not file.exists():
                problems.append(f"{page.relative_to(ROOT)} links to {target}, which does not exist")
    problems += [f"no page links to {p.relative_to(ROOT)}" for p in pages if p.is_relative_to(ROOT / "docs") and p not in linked]
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
