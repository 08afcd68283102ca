#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""How the time and the memory of an iteration grow with the Gaussians and with the pixels.

    bench/lab/growth.py run --program build/bench/bench/lab/lab --output bench/results/growth.json -- --device cuda
    bench/lab/growth.py table bench/results/growth.json
    bench/lab/growth.py plot bench/results/growth.json growth.png          # needs matplotlib

Each point is a process of its own, and so its peak of memory. Of each curve the table gives the exponent (the slope
of the logarithms, by least squares), that of the part where it grows (its last third), and the largest step between
neighbors, as the time's ratio over the size's: above 1 an iteration takes more than its share, and a cliff shows.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
from environment import environment, own_and_passed_on  # noqa: E402

CURVES = {"gaussians": [(n, 800) for n in (10_000, 20_000, 40_000, 80_000, 160_000, 320_000, 640_000, 1_250_000,
                                           2_500_000, 5_000_000)],
          "pixels": [(250_000, side) for side in (320, 448, 640, 896, 1264, 1792, 2528, 2832)]}


def run(arguments):
    curves = {}
    for name, points in CURVES.items():
        curves[name] = []
        for gaussians, side in points:
            command = [arguments.program, "growth", "--gaussians", str(gaussians), "--side", str(side), *arguments.options]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
            curves[name].append(json.loads(done.stdout))
            print(gaussians, side, f"{curves[name][-1]['milliseconds']:.3f} ms", flush=True)
    result = {"bench": "growth", "options": arguments.options, **environment(arguments.commit), "curves": curves}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")


def slope(points):
    """Of y over x by least squares."""
    return statistics.linear_regression(*zip(*points)).slope


def peak(row):
    return row["peak_device_bytes"] or row["peak_host_bytes"]


def summary(name, rows):
    """The exponent of a curve, that of its last third, its steepest step, and bytes per unit of its size."""
    logs = [(math.log(row[name]), math.log(row["milliseconds"])) for row in rows]
    ratio, size = max((math.exp(b[1] - a[1] - (b[0] - a[0])), b[0]) for a, b in zip(logs, logs[1:]))
    return {"exponent": slope(logs), "last_exponent": slope(logs[-max(3, len(logs) // 3):]), "steepest": ratio,
            "steepest_to": round(math.exp(size)), "bytes": slope([(row[name], peak(row)) for row in rows])}


def table(arguments):
    result = json.loads(pathlib.Path(arguments.file).read_text())
    first = result["curves"]["gaussians"][0]
    machine = result["gpu_and_driver"] if first["device"].startswith("cuda") else result["processor"].strip()
    print(f"{first['device']}, {machine}, commit {result['commit']}\n")
    print("| by | from | to | ms | exponent | at the end | steepest step, time over size | bytes for one more |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for name, rows in result["curves"].items():
        found = summary(name, rows)
        print(f"| {name} | {rows[0][name]:,} | {rows[-1][name]:,} | {rows[0]['milliseconds']:.2f} to "
              f"{rows[-1]['milliseconds']:.2f} | {found['exponent']:.2f} | {found['last_exponent']:.2f} | "
              f"{found['steepest']:.2f} (to {found['steepest_to']:,}) | {found['bytes']:,.0f} |")
    for name, rows in result["curves"].items():
        print(f"\n| {name} | ms (least to most) | " + " | ".join(rows[0]["stages"]) + " | million pairs | peak MiB |")
        print("| --- |" + " --- |" * (len(rows[0]["stages"]) + 3))
        for row in rows:
            stages = " | ".join(f"{ms:.3f}" for ms in row["stages"].values())
            print(f"| {row[name]:,} | {row['milliseconds']:.3f} ({row['least_milliseconds']:.3f} to "
                  f"{row['most_milliseconds']:.3f}) | {stages} | {row['pairs'] / 1e6:.1f} | {peak(row) / 2**20:,.0f} |")


def plot(arguments):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    result = json.loads(pathlib.Path(arguments.file).read_text())
    figure, axes = pyplot.subplots(1, len(result["curves"]), figsize=(11, 4.5), sharey=True)
    for axis, (name, rows) in zip(axes, result["curves"].items()):
        sizes = [row[name] for row in rows]
        axis.loglog(sizes, [row["milliseconds"] for row in rows], "k.-", label="iteration")
        for stage in rows[0]["stages"]:
            axis.loglog(sizes, [row["stages"][stage] for row in rows], ".-", linewidth=1, label=stage)
        other = {"gaussians": "pixels", "pixels": "gaussians"}[name]
        axis.set(xlabel=f"{name} ({rows[0][other]:,} {other})", title=f"exponent {summary(name, rows)['exponent']:.2f}")
        axis.grid(which="both", alpha=0.2)
    axes[0].set_ylabel(f"ms, {rows[0]['device']}")
    axes[0].legend(fontsize=8)
    figure.savefig(arguments.plot, dpi=120, bbox_inches="tight")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run", help="after --: options of the program, for every point")
    runner.add_argument("--program", required=True)
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=table)
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("plot")
    plotter.set_defaults(action=plot)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


main()
