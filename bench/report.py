#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Writes docs/reference/benchmarks.md and the README's table from the result sets of bench/run.py and bench/fronts.py.

With --check it writes nothing, and fails if a page differs from the result sets, or if another page
of the documentation contains a measured figure.
"""
import argparse
import json
import pathlib
import re
import sys
import textwrap
import tomllib

import fronts
from markdown_tables import markdown

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "reference" / "benchmarks.md"
README = ROOT / "README.md"
README_TABLE = re.compile(r"(<!-- benchmarks -->\n\n?).*?(\n?<!-- end of benchmarks -->)", re.DOTALL)
PROFILES = {"gpu": "On a GPU", "cpu": "On a CPU"}
FRONTS = ROOT / "bench" / "results" / "fronts.json"

# A number with the unit of something that was measured.
MEASURED = re.compile(r"\b\d[\d,.]*\s?(?:dB|ms|µs|it/s|MiB|GiB|GB/s|(?:times|×) (?:as fast|faster|the time))(?!\w)")
# Pages whose numbers are limits and settings of the program.
WITH_SETTINGS = {"reference/cli.md", "reference/benchmarks.md"}

INTRODUCTION = """# Benchmarks

<!-- Written by bench/report.py from bench/results. Do not edit. -->

This page is for readers who want to know how fast and how accurate warpagg is, and who want to
repeat a measurement. The figures of the sections "On a GPU" and "On a CPU" come from one run of
`bench/run.py` each, on one machine, at one commit. [How we measure](../contributing/how_we_measure.md) explains the method, and
[bench/suite.toml](../../bench/suite.toml) lists the commands.

"""

BUDGETS = """## Quality by time and by number of Gaussians

`bench/fronts.py` trains each scene with several numbers of iterations, and with several limits of
Gaussians. `before` is an older version of the trainer, which takes turns with the current one
(`now`). The captions name both commits.

![Held-out PSNR against seconds of training, one panel per scene](../images/fronts_seconds.svg)

![Held-out PSNR against the number of Gaussians, one panel per scene](../images/fronts_gaussians.svg)

"""


def result_sets():
    files = {p: ROOT / "bench" / "results" / f"{p}.json" for p in PROFILES}
    return {p: json.loads(f.read_text()) for p, f in files.items() if f.exists()}


def suite():
    return tomllib.loads((ROOT / "bench" / "suite.toml").read_text())["measurement"]


def machine(profile, about):
    named = [("GPU and driver", "gpu_and_driver"), ("CUDA compiler", "nvcc")] if profile != "cpu" else []
    named += [("processor", "processor"), ("compiler", "compiler"), ("commit", "commit")]
    return markdown(["", ""], [[name, about[key].strip()] for name, key in named if about.get(key)])


def filled(text):
    return textwrap.fill(" ".join(text.split()), 98, break_long_words=False, break_on_hyphens=False) + "\n\n"


def titled(table):
    return (filled(table["title"] + ":") if table["title"] else "") + markdown(table["columns"], table["rows"])


def page(results):
    text = INTRODUCTION
    for profile, result in results.items():
        text += f"## {PROFILES[profile]}\n\n{machine(profile, result['about'])}\n"
        for measurement in suite():
            found = result["measurements"].get(measurement["name"])
            if profile in measurement["profiles"] and found:
                tables = "\n".join(titled(t) for t in found["tables"])
                text += f"### {measurement['title']}\n\n{filled(measurement['reading'])}{tables}\n"
    if FRONTS.exists():
        text += BUDGETS + fronts.tables(json.loads(FRONTS.read_text()))
    return text.rstrip() + "\n"


def training_rows(result, measurement, device, title, schedule, scenes):
    tables = result["measurements"][measurement]["tables"]
    table = next(t for t in tables if t["title"] == title)
    at = {name: i for i, name in enumerate(table["columns"])}
    middle = lambda row, name: row[at[name]].split(" (")[0]
    return [[scenes[row[0]], schedule, device, middle(row, "held-out PSNR, dB"), middle(row, "seconds"), middle(row, "Gaussians")]
            for row in table["rows"] if row[0] in scenes]


def readme_table(results):
    """Medians of three seeds, from the training tables of the page."""
    rows = []
    if "gpu" in results:
        gpu = results["gpu"]["about"]["gpu_and_driver"].split(",")[0]
        photos = {"lego": "lego, 400×400", "fern": "fern, 696×521", "train": "train, 800×444"}
        rows += training_rows(results["gpu"], "training", gpu, "`--quality fast`", "`--quality fast`", photos)
        rows += training_rows(results["gpu"], "training", gpu, "7,000 iterations (the default)", "7,000 iterations", photos)
        rows += training_rows(results["gpu"], "training", gpu, "30,000 iterations", "30,000 iterations", photos)
    if "cpu" in results:
        cores = re.search(r"(\d+) processors", results["cpu"]["about"]["processor"]).group(1)
        rows += training_rows(results["cpu"], "training_cpu", f"CPU, {cores} cores", "1,500 iterations (the demo)", "1,500 iterations",
                              {"synthetic:spheres": "spheres, the demo"})
    return markdown(["scene", "schedule", "device", "held-out PSNR, dB", "seconds", "Gaussians"], rows)


def figures_in_prose():
    for file in sorted((ROOT / "docs").rglob("*.md")):
        if str(file.relative_to(ROOT / "docs")) in WITH_SETTINGS:
            continue
        for number, line in enumerate(file.read_text().splitlines(), 1):
            for found in MEASURED.finditer(line):
                yield f"{file.relative_to(ROOT)}:{number}: '{found.group()}' is a measured figure; link to reference/benchmarks.md instead"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args().check
    results = result_sets()
    readme = README.read_text()
    written = {PAGE: page(results),
               README: README_TABLE.sub(lambda m: f"{m.group(1)}{readme_table(results)}{m.group(2)}", readme)}
    if not README_TABLE.search(readme):
        raise SystemExit("error: README.md has no line '<!-- benchmarks -->'")
    problems = list(figures_in_prose())
    outside_table = README_TABLE.sub("", readme)
    problems += [f"README.md: '{m.group()}' is a measured figure outside of the generated table" for m in MEASURED.finditer(outside_table)]
    for file, text in written.items():
        if not file.exists() or file.read_text() != text:
            if check:
                problems.append(f"{file.relative_to(ROOT)} differs from bench/results; run bench/report.py")
            else:
                file.write_text(text)
    print("\n".join(problems), end="\n" if problems else "", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
