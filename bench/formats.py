#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Prints the size and the loss of PSNR of a model in each format, as a Markdown table.

    bench/formats.py PROGRAM SCENE... --model MODEL.ply [--device cpu]
    bench/formats.py PROGRAM SCENE... [-- options of train]

Without --model, trains each scene first (with --eval, and the options after --). Then converts the model to
each format, measures the file on the held-out views with `evaluate`, and compares with the .ply. The loss is the
PSNR of the .ply minus the PSNR of the format, in dB. Seconds are of `convert`, the median of three runs, with
the spread (largest - smallest) / median.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from markdown_tables import markdown

FORMATS = {
    ".ply": ("ply", []),
    ".compressed.ply": ("compressed.ply", []),
    ".spz, version 4": ("spz", []),
    ".spz, version 3": ("spz", ["--spz-version", "3"]),
    ".sog": ("sog", []),
    ".glb": ("glb", []),
    ".splat": ("splat", []),
}


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def trained(program, scene, device, options, folder):
    output = folder / "run"
    run(program, "train", "--data", scene, "--eval", "--output", output, "--device", device, "--overwrite", *options)
    models = sorted(output.glob("point_cloud/iteration_*/point_cloud.ply"), key=lambda p: int(p.parent.name[10:]))
    return models[-1]


def psnr_of(program, model, scene, device, options, folder):
    output = folder / "measured"
    run(program, "evaluate", model, "--data", scene, "--eval", "--output", output, "--device", device, *options)
    return json.loads((output / "metrics.json").read_text())["psnr"]


def seconds_of(program, model, file, device, options):
    times = []
    for _ in range(3):
        start = time.monotonic()
        run(program, "convert", model, file, "--device", device, *options)
        times.append(time.monotonic() - start)
    median = statistics.median(times)
    return median, (max(times) - min(times)) / median


def rows_of(program, scene, model, device, measure_options, folder):
    rows, exact = [], None
    for name, (ending, options) in FORMATS.items():
        file = folder / f"model.{ending}"
        file.unlink(missing_ok=True)
        seconds, spread = seconds_of(program, model, file, device, options)
        psnr = psnr_of(program, file, scene, device, measure_options, folder)
        exact = psnr if exact is None else exact
        size = file.stat().st_size
        rows.append([pathlib.Path(scene).name, name, f"{size / 1e6:.2f}", f"{model.stat().st_size / size:.1f}",
                     f"{psnr:.2f}", f"{round(exact - psnr, 2) + 0:.2f}", f"{seconds:.2f}", f"{spread:.0%}"])
    return rows


def main():
    words = sys.argv[1:]
    split = words.index("--") if "--" in words else len(words)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--model", type=pathlib.Path, help="the model of the only scene")
    parser.add_argument("--device", default="auto")
    parser.add_argument("-r", "--resolution", help="of training and measuring")
    given = parser.parse_args(words[:split])
    if given.model and len(given.scenes) > 1:
        parser.error("--model is for one scene")
    measure_options = ["-r", given.resolution] if given.resolution else []
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene in given.scenes:
            model = given.model or trained(given.program, scene, given.device,
                                           measure_options + words[split + 1:], folder)
            rows += rows_of(given.program, scene, model, given.device, measure_options, folder)
    print(markdown(["scene", "format", "MB", "times smaller", "PSNR", "loss (dB)", "s", "spread"], rows))


main()
