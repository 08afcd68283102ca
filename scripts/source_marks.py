# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Marks in sources, at which scripts put other code into a copy of them.

A mark is a comment `// KIND: PLACE`, with several places separated by commas. At the end of a line it marks
this line, on a line of its own the next one. An edit names a place and what happens to its line:

    at = "PLACE"        # one edit of a fault may leave it out, if the place has the name of the fault
    new = "text"        # stands in place of the line
    before = "text"     # stands before the line
    after = "text"      # stands after the line
"""
import pathlib
import re

SUFFIXES = (".hpp", ".cpp", ".cu")


class MarkError(Exception):
    """A mark that is missing, or is there twice."""


def marks_in(text, kind):
    """By place, the index of the marked line."""
    found = {}
    lines = text.split("\n")
    for index, line in enumerate(lines):
        mark = re.search(rf"// {kind}: ([\w, ]+)$", line)
        if not mark:
            continue
        is_alone = line[:mark.start()].strip() == ""
        for place in mark[1].split(","):
            if place.strip() in found:
                raise MarkError(f"{place.strip()} is marked twice")
            found[place.strip()] = index + 1 if is_alone else index
    return found


def find_marks(folder, kind):
    """By place, the file in the folder that has the mark."""
    files = {}
    for file in sorted(p for p in pathlib.Path(folder).rglob("*") if p.suffix in SUFFIXES):
        for place in marks_in(file.read_text(), kind):
            if place in files:
                raise MarkError(f"{place} is marked in {files[place]} and in {file}")
            files[place] = file
    return files


def check(places, used, kind):
    """Throws unless the marked places are exactly those that edits use."""
    if missing := sorted(set(used) - set(places)):
        raise MarkError(f"no line has the mark // {kind}: {missing[0]}")
    if unused := sorted(set(places) - set(used)):
        raise MarkError(f"{places[unused[0]]} has the mark // {kind}: {unused[0]}, which nothing uses")


def edited(text, kind, edits):
    """The text after the edits, each of which has `at`."""
    lines = text.split("\n")
    places = marks_in(text, kind)
    for edit in edits:
        index = places[edit["at"]]
        line = re.sub(r" *// \w+: [\w, ]+$", "", lines[index])
        parts = [edit.get("before"), edit.get("new", line), edit.get("after")]
        lines[index] = "\n".join(part.strip("\n") for part in parts if part is not None)
        for other in [p for p, i in places.items() if i == index]:
            del places[other]  # its line has changed
    return "\n".join(lines)
