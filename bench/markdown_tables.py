# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Markdown tables as data, and back."""


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def parse_tables(text):
    """The tables in a text: each with its title, which is the last line of text before it, its columns and rows."""
    tables, title, table = [], "", None
    for line in map(str.strip, text.splitlines()):
        if not line.startswith("|"):
            table = None
            title = line or title
        elif table is None:
            table = {"title": title.rstrip(":"), "columns": cells_of(line), "rows": []}
            tables.append(table)
            title = ""
        elif not set(line) <= set("|-: "):
            table["rows"].append(cells_of(line))
    return [table for table in tables if table["rows"]]


def markdown(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"
