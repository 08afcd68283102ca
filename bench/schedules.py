#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""What each switch of the training schedule gains in time and costs in PSNR: scenes trained by default, by default with
each switch alone, and with --quality fast, in turn.

    bench/schedules.py --build build/cuda --data ../shared/data --scenes lego --seeds 0 -- --device cuda

The options after -- are those of every run. It writes bench/results/schedules.json, of which bench/tables.py makes the
table of docs/speed.md.
"""
import argparse
import json
import pathlib
import statistics
import types

from environment import environment, own_and_passed_on
from scenes import by
from train import measure, ratios

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEFAULT = "default"


def variants(iterations, gaussians):
    """By name, the options of each. `gaussians`: what the default grows to."""
    length = ["-i", str(iterations)]
    alone = [["--sh-lr", "1.25e-4"],
             ["--sh-lr", "5e-4"],
             ["--sh-degree-interval", "1000"],
             ["--sh-update-interval", "4", "--sh-lr", "5e-4"],
             ["--scaling-lr", "5e-3"],
             ["--no-revised-opacity"],
             ["--prune-share", "0"],
             ["--num-downscales", "0"]]
    return {**{f"`{' '.join(own)}`": [*length, *own] for own in alone},
            "`--budget` of 4/5 of the default's": [*length, "--budget", str(gaussians * 4 // 5)],
            "`--quality fast`": ["--quality", "fast"]}


def to_default(runs, scene):
    """Of a scene, how each variant compares to the default, by medians."""
    sets = by("options", [r for r in runs if r["scene"] == scene])
    return {name: ratios(sets[DEFAULT], same) for name, same in sets.items() if name != DEFAULT}


def run(arguments):
    program = pathlib.Path(arguments.build) / "examples" / "gaussian_splatting" / "gaussian_splatting"
    runs = []
    for scene in arguments.scenes:
        one = types.SimpleNamespace(program=str(program), data=pathlib.Path(arguments.data) / scene, seeds=arguments.seeds)
        length = ["-i", str(arguments.iterations)]
        runs += measure(one, {DEFAULT: [*length, *arguments.options]})
        others = variants(arguments.iterations, statistics.median_low(r["gaussians"] for r in runs if r["scene"] == scene))
        runs += measure(one, {name: [*options, *arguments.options] for name, options in others.items()})
    return runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", required=True, help="the build directory")
    parser.add_argument("--data", required=True, help="the folder of the scenes")
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--seeds", nargs="+", type=int, default=[0])
    parser.add_argument("--iterations", type=int, default=7000)
    parser.add_argument("--commit", help="where the sources are no git checkout")
    parser.add_argument("--output", default=ROOT / "bench" / "results" / "schedules.json")
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    runs = run(arguments)
    result = {"bench": "schedules", "options": arguments.options, **environment(arguments.commit), "runs": runs,
              "to_default": {scene: to_default(runs, scene) for scene in arguments.scenes}}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")
    for scene, rows in result["to_default"].items():
        for name, r in rows.items():
            print(f"{scene:16} {name:60} {r['dB']:+.2f} dB, loop x{r['loop']:.2f}, Gaussians x{r['Gaussians']:.2f}")


if __name__ == "__main__":
    main()
