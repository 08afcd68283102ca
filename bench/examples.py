#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Reads the tables that the examples print from standard input and writes them as JSON.

    for e in histogram kmeans_update; do build/test/examples/$e; done |
        bench/examples.py > bench/results/examples_emulator.json
    for e in histogram kmeans_update; do build/cuda/examples/${e}_cuda 16777216; done |
        bench/examples.py --figures bench/results/atomics.json > bench/results/examples_gpu.json

--figures names a result of the same machine and commit, whose GPU, driver, compiler and commit are taken over.
"""
import argparse
import json
import sys


def tables(lines):
    """The tables in the text: each with the line that stands before it, its columns and its rows."""
    title, columns, rows = "", None, []
    for line in lines:
        line = line.strip()
        if line.startswith("|"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if columns is None:
                columns = cells
            elif not set(line) <= set("|- "):
                rows.append(dict(zip(columns, cells)))
        elif line:
            if columns:
                yield {"title": title, "rows": rows}
            title, columns, rows = line, None, []
    if columns:
        yield {"title": title, "rows": rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--figures")
    path = parser.parse_args().figures
    out = {"bench": "examples", "seed": 12345}
    if path:
        with open(path) as file:
            figures = json.load(file)
        out.update({key: figures[key] for key in ("gpu", "driver", "nvcc", "commit")})
        out["rounds"] = 9
    out["tables"] = list(tables(sys.stdin))
    json.dump(out, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
