#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Draws how a held-out view changes with the seed, without regularization and by default: needs matplotlib.

    bench/floaters.py build/release/examples/gaussian_splatting/gaussian_splatting docs/images/floaters.png

Trains a synthetic scene with six photos on the CPU for each seed. The view is the one with the lowest mean
PSNR without regularization.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

TRAIN = ["-d", "synthetic:spheres,views=4,points=500", "-r", "192", "-i", "3000", "--eval", "--device", "cpu",
         "--deterministic", "-q"]
ROWS = {"without": ["--dropout", "0", "--opacity-penalty", "0"], "default": []}
SEEDS = (0, 1, 2)


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("program", help="the trainer")
    words.add_argument("picture", type=pathlib.Path, help="the PNG to write")
    args = words.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    with tempfile.TemporaryDirectory() as folder:
        runs, psnr = {}, {}
        for row, options in ROWS.items():
            for seed in SEEDS:
                out = pathlib.Path(folder) / f"{row}{seed}"
                subprocess.run([args.program, "train", *TRAIN, "--seed", str(seed), "-o", out, *options], check=True)
                views = json.loads((out / "metrics.json").read_text())["views"]
                runs[row, seed] = out
                psnr[row, seed] = [view["psnr"] for view in views]
                print(row, "seed", seed, *(f"{p:.1f}" for p in psnr[row, seed]))
        sums = [sum(of) for of in zip(*(psnr["without", seed] for seed in SEEDS))]
        view = sums.index(min(sums))
        figure, axes = pyplot.subplots(len(ROWS), len(SEEDS) + 1, figsize=(8, 4.3), layout="constrained")
        for axis in axes.flat:
            axis.set_axis_off()
        for r, row in enumerate(ROWS):
            for s, seed in enumerate(SEEDS):
                images = sorted(runs[row, seed].glob("test/*/renders/*.png"))
                axes[r, s + 1].imshow(pyplot.imread(images[view]))
                axes[r, s + 1].set_title(f"{row}, seed {seed}", fontsize=9)
        axes[0, 0].imshow(pyplot.imread(sorted(runs["default", SEEDS[0]].glob("test/*/gt/*.png"))[view]))
        axes[0, 0].set_title("photo", fontsize=9)
        figure.savefig(args.picture, dpi=100)


if __name__ == "__main__":
    main()
