#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Runs the measurements of bench/suite.toml and keeps their tables as one result set.

    cmake --preset bench && cmake --build --preset bench
    bench/run.py --profile gpu --build build/bench --data SCENES
    bench/report.py

A measurement is a list of shell commands. The Markdown tables that they print are its result. The
result set is written after each measurement, and the same command goes on where it was stopped.
Results of another commit or machine are refused; --fresh discards them. --only NAME runs a
measurement again.
"""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import tomllib

from environment import compilers_of, environment
from markdown_tables import parse_tables
from result_file import load, save

BENCH = pathlib.Path(__file__).resolve().parent
SUITE = BENCH / "suite.toml"


def measurements_of(profile):
    suite = tomllib.loads(SUITE.read_text())
    if profile not in suite["profiles"]:
        raise SystemExit(f"error: bench/suite.toml has no profile '{profile}'; it has {', '.join(suite['profiles'])}")
    return [m for m in suite["measurement"] if profile in m["profiles"]]


def definition_of(measurement):
    """Changes whenever the commands of a measurement change."""
    return hashlib.sha256(json.dumps(measurement["run"]).encode()).hexdigest()[:16]


def measure(measurement, variables):
    start = time.monotonic()
    printed = ""
    with tempfile.TemporaryDirectory() as work:
        environment_of_commands = {**os.environ, **variables, "WORK": work, "BENCH": str(BENCH)}
        for command in measurement["run"]:
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], text=True, stdout=subprocess.PIPE,
                                  env=environment_of_commands, cwd=BENCH.parent)
            if done.returncode:
                raise SystemExit(f"error: {measurement['name']}: exit status {done.returncode} of\n  {command}\n{done.stdout[-2000:]}")
            printed += done.stdout
    tables = parse_tables(printed)
    if not tables:
        raise SystemExit(f"error: {measurement['name']} printed no table:\n{printed[-2000:]}")
    return {"definition": definition_of(measurement), "seconds": round(time.monotonic() - start, 1), "tables": tables}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--profile", required=True, help="cpu or gpu")
    parser.add_argument("--build", default="build/bench", type=pathlib.Path, help="build folder (default: build/bench)")
    parser.add_argument("--data", default="scenes", type=pathlib.Path, help="folder of the real scenes (default: scenes)")
    parser.add_argument("--output", type=pathlib.Path, help="result set (default: bench/results/PROFILE.json)")
    parser.add_argument("--commit", help="commit of the sources, if they are no git checkout")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="run this measurement again; may be repeated")
    parser.add_argument("--fresh", action="store_true", help="discard earlier results")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="start no measurement after this time")
    arguments = parser.parse_args()

    chosen = measurements_of(arguments.profile)
    unknown = set(arguments.only) - {m["name"] for m in chosen}
    if unknown:
        raise SystemExit(f"error: profile '{arguments.profile}' has no measurement '{sorted(unknown)[0]}'")
    output = arguments.output or BENCH / "results" / f"{arguments.profile}.json"
    about = {**environment(arguments.commit), **compilers_of(arguments.build)}
    results = load(output, about, arguments.fresh) or {"about": about, "measurements": {}}
    variables = {"BUILD": str(arguments.build.resolve()), "DATA": str(arguments.data.resolve()),
                 "DEVICE": "cpu" if arguments.profile == "cpu" else "cuda"}

    start = time.monotonic()
    missing = []
    for measurement in chosen:
        name = measurement["name"]
        known = results["measurements"].get(name, {}).get("definition") == definition_of(measurement)
        if name not in arguments.only and (arguments.only or known):
            continue
        if time.monotonic() - start > arguments.seconds:
            missing.append(name)
            continue
        print(f"{name} ...", file=sys.stderr, flush=True)
        results["measurements"][name] = measure(measurement, variables)
        save(output, results)
        print(f"{name}: {results['measurements'][name]['seconds']:.0f} s", file=sys.stderr, flush=True)
    if missing:
        raise SystemExit(f"error: no time was left for {', '.join(missing)}; run the same command again")


if __name__ == "__main__":
    main()
