#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Draws what bench_accuracy measured, in black and white: needs matplotlib.

    bench/plot.py bench/results/accuracy_emulator.json docs/images/accuracy_emulator.svg
"""
import argparse
import json
import pathlib

CONDITION = "condition 1e"
MARKERS = {"native": "o", "f64": "s", "compensated": "^", "fixed, scaled to fit": "D", "binned<2>": "v", "binned<3>": "<", "exact": "*", "ordered": "P"}


def of(row):
    return {tag["tag"]: tag for tag in row["tags"]}


def errors_by_condition(axis, rows):
    rows = sorted((r for r in rows if r["values"].startswith(CONDITION)), key=lambda r: r["condition"])
    conditions = [r["condition"] for r in rows]
    for tag, marker in MARKERS.items():
        errors = [of(r)[tag]["largest_error"] for r in rows]
        axis.loglog(conditions, errors, "k-", marker=marker, markerfacecolor="white", linewidth=0.8, label=tag)
    n, u = rows[0]["n"], 2.0 ** -24
    for label, style, bound in (("bound of native", ":", lambda k: n * u * k),
                                ("bound of compensated", "-.", lambda k: u + 5 * n * u * u * k),
                                ("bound of f64", "--", lambda k: u + n * 2.0 ** -53 * k)):
        axis.loglog(conditions, [bound(k) for k in conditions], color="0.5", linestyle=style, linewidth=1, label=label)
    axis.set(xlabel="condition number of the sum", ylabel="largest relative error", ylim=(1e-9, 1e3), title=f"{n:,.0f} values, one sum")
    axis.legend(fontsize=7, ncol=4, loc="upper center", bbox_to_anchor=(0.5, -0.13))
    axis.grid(alpha=0.2)


def errors_by_time(axis, rows, values):
    for row, face in zip(sorted((r for r in rows if r["values"] == values), key=lambda r: r["sums"]), ("white", "black")):
        for tag, marker in MARKERS.items():
            found = of(row)[tag]
            axis.loglog(found["nanoseconds_a_value"]["median"], found["largest_error"], "k", marker=marker, markerfacecolor=face, linestyle="")
    axis.set(xlabel="ns a value (white: one sum, black: many)", ylabel="largest relative error", title=f"{values}: error against time")
    axis.grid(alpha=0.2)


def where(result):
    return f"{result['device']}, " + ("" if result["device"].startswith("cuda") else f"{result['processor']}, ") + f"commit {result['commit']}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("plot")
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "warpagg"  # the same file from the same figures
    from matplotlib import pyplot
    result = json.loads(pathlib.Path(arguments.file).read_text())
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.5))
    errors_by_condition(left, [r for r in result["rows"] if r["sums"] == 1])
    errors_by_time(right, result["rows"], "condition 1e06")
    figure.suptitle(where(result), fontsize=8)
    figure.savefig(arguments.plot, bbox_inches="tight", metadata={"Date": None})


main()
