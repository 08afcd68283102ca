#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Trains one scene by one or more sets of options, in turn, and compares them: PSNR against time, stages, ratios.

    bench/train.py run --program build/cuda/.../gaussian_splatting --data ../shared/data/lego --seeds 0 1 2 \\
        --output lego.json -- -i 7000 --test-iterations 1000 3500 -- -i 7000 --test-iterations 1000 3500 --quality fast
    bench/train.py table lego.json
    bench/train.py plot lego.json lego.png          # needs matplotlib

Each -- begins a set of options; the ratios are to the first. Beside the JSON comes a CSV of the held-out PSNR and
SSIM against the seconds in the loop, in which testing does not count.
"""
import argparse
import csv
import json
import pathlib
import statistics

from environment import environment, own_and_passed_on
from scenes import by, print_tables, train, where

COLUMNS = ["options", "seed", "iteration", "seconds", "psnr", "ssim"]


def measure(arguments, configurations, programs={}):
    """Runs of each configuration (a name and its options) by each seed. Those of one seed follow one another, so
    that a machine which slows down slows down all of them. `programs`: of those that have one of their own."""
    runs = []
    data = pathlib.Path(arguments.data)
    for seed in arguments.seeds:
        for name, options in configurations.items():
            one = train(programs.get(name, arguments.program), data.parent, data.name, seed, options)
            runs.append({"options": name, **one})
            print(data.name, seed, name, f"{one['psnr']:.2f} dB", f"{one['seconds']['train']:.1f} s", flush=True)
    return runs


def curve(run):
    """What was held out, from test to test, as the rows of the CSV."""
    last = {"iteration": run["iterations"], "seconds": run["seconds"]["train"], "psnr": run["psnr"], "ssim": run["ssim"]}
    tests = [t for t in run["tests"] if t["iteration"] < run["iterations"]]
    return [{"options": run["options"], "seed": run["seed"], **test} for test in [*tests, last]]


def run(arguments):
    runs = measure(arguments, {" ".join(options): options for options in arguments.options})
    result = {"bench": "train", **environment(arguments.commit), "runs": runs}
    output = pathlib.Path(arguments.output)
    output.write_text(json.dumps(result, indent=1) + "\n")
    with output.with_suffix(".csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS)
        writer.writeheader()
        for one in runs:
            writer.writerows(curve(one))
    show(result)


def ratios(first, other):
    """How often one set of runs holds the time and the Gaussians of another, and what PSNR it adds."""
    middle = lambda runs, pick: statistics.median(pick(r) for r in runs)
    of = lambda pick: middle(other, pick) / middle(first, pick)
    stages = {s: of(lambda r: r["stages"][s]["milliseconds"]) for s in first[0]["stages"]}
    return {"loop": of(lambda r: r["seconds"]["train"]), "process": of(lambda r: r["seconds"]["process"]),
            "iteration": of(lambda r: 1 / r["iterations_per_second"]), **stages, "Gaussians": of(lambda r: r["gaussians"]),
            "dB": middle(other, lambda r: r["psnr"]) - middle(first, lambda r: r["psnr"])}


def show(result, title=None):
    runs = result["runs"]
    print(f"\n{title or runs[0]['scene'] + ', ' + where(result)}\n")
    print_tables("options", runs)
    sets = by("options", runs)
    first = next(iter(sets))
    for name, same in sets.items():
        if name == first:
            continue
        parts = [f"{value:+.2f} dB" if key == "dB" else f"{key} x{value:.3f}"
                 for key, value in ratios(sets[first], same).items()]
        print(f"\n`{name}` to `{first}`: {', '.join(parts)}")


def plot(arguments):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    result = json.loads(pathlib.Path(arguments.file).read_text())
    figure, axis = pyplot.subplots(figsize=(8, 5))
    for color, (name, same) in enumerate(by("options", result["runs"]).items()):
        for i, one in enumerate(same):
            rows = curve(one)
            axis.plot([r["seconds"] for r in rows], [r["psnr"] for r in rows], ".-", color=f"C{color}", linewidth=1,
                      label=None if i else name)
    axis.set(xlabel=f"seconds in the loop, {result['runs'][0]['device']}", ylabel="held-out PSNR, dB",
             title=result["runs"][0]["scene"])
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    figure.savefig(arguments.plot, dpi=120, bbox_inches="tight")


def add_run(commands, action):
    runner = commands.add_parser("run")
    runner.add_argument("--program", required=True)
    runner.add_argument("--seeds", nargs="+", type=int, default=[0])
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=action)
    return runner


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    add_run(commands, run).add_argument("--data", required=True, help="the scene")
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.add_argument("--title", help="line above the table (default: scene, machine, commit and seeds)")
    shower.set_defaults(action=lambda arguments: show(json.loads(pathlib.Path(arguments.file).read_text()), arguments.title))
    plotter = commands.add_parser("plot")
    plotter.add_argument("file")
    plotter.add_argument("plot")
    plotter.set_defaults(action=plot)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on or [[]]
    arguments.action(arguments)


if __name__ == "__main__":
    main()
