#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Counts what the default blending kernels do, with ncu, on the scenes of `lab backward`: instructions, sectors and
bytes for each pixel-Gaussian pair that is evaluated, and how busy the GPU's instruction issue is meanwhile.

    bench/lab/roofline.py --program build/bench/bench/lab/lab --output bench/results/roofline.json \
        --scene random --scene "lego:model.ply -d ../shared/data/lego"
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
from environment import environment  # noqa: E402
import ncu  # noqa: E402

METRICS = {
    "nanoseconds": "gpu__time_duration.sum",
    "instructions": "smsp__inst_executed.sum",
    "issue_percent": "smsp__issue_active.avg.pct_of_peak_sustained_active",
    "device_memory_bytes": "dram__bytes.sum",
    "l2_sectors": "lts__t_sectors.sum",
    "reductions": "smsp__inst_executed_op_global_red.sum",
}
# The kernels of the ladder's last rung, forward and backward.
KERNELS = {"forward": r"blend_forward<float", "backward": r"blend_backward<float.*>, (1|true), .*scatter"}


def count(program, name, arguments):
    arguments = ["backward", *arguments, "--views", "1", "--rounds", "1"]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "figures.json"
        subprocess.run([program, *arguments, "-o", out], check=True, capture_output=True)
        figures = json.loads(out.read_text())
    split = next(v for v in figures["ladder"] if v["name"] == "split")
    rows = ncu.profile([program, *arguments], "blend_(forward|backward)", 2 * len(figures["ladder"]), METRICS)  # the ladder comes first
    result = {"scene": name, "width": figures["width"], "height": figures["height"], "gaussians": figures["gaussians"],
              "pairs": split["pairs"]}
    for kernel, pattern in KERNELS.items():
        found = [r for r in rows if re.search(pattern, r["kernel"])]
        result[kernel] = {key: statistics.median(r[key] for r in found) for key in METRICS}
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scene", action="append", required=True, help="NAME, or NAME:arguments of `lab backward`")
    parser.add_argument("--commit", help="where the sources are no git checkout")
    parser.add_argument("--output", required=True)
    arguments = parser.parse_args()
    scenes = []
    for scene in arguments.scene:
        name, _, rest = scene.partition(":")
        scenes.append(count(arguments.program, name, rest.split()))
    result = {"bench": "roofline", **environment(arguments.commit), "scenes": scenes}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")


main()
