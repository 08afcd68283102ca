#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Runs test_hard_cases and keeps its table as JSON, with the machine and the commit that it is of.

    bench/hard_cases.py --program build/cuda/tests/test_hard_cases --output bench/results/hard_cases.json
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from environment import environment


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--commit", help="where the sources are no git checkout")
    parser.add_argument("--output", required=True)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "table.json"
        done = subprocess.run([arguments.program], env={**os.environ, "WARPAGG_CASES_JSON": str(file)})
        found = json.loads(file.read_text())
    result = {"bench": "hard_cases", **environment(arguments.commit), **found}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")
    sys.exit(done.returncode)


main()
