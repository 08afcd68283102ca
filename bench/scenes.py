#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Trains scenes and keeps what each run measured, as JSON; or shows such JSON as a table.

    bench/scenes.py run --program build/cuda/.../gaussian_splatting --data ../shared/data \
        --scenes fern truck --seeds 0 1 2 --output bench/results/colmap.json -- -i 7000 --device cuda
    bench/scenes.py table bench/results/colmap.json
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

from environment import environment, own_and_passed_on

KEPT = ["psnr", "ssim", "training_psnr", "gaussians", "iterations", "iterations_per_second", "seconds", "densify_seconds",
        "skipped_steps", "pairs_per_iteration", "stages", "peak_host_bytes", "peak_device_bytes", "seed", "device",
        "gradient", "tests"]  # the rung of the ladder only from bench/lab


def train_into(folder, program, data, scene, seed, options):
    """One run, whose results stay in the folder: what metrics.json says of it, and the seconds of the whole process."""
    source = scene if scene.startswith("synthetic:") else str(pathlib.Path(data) / scene)
    command = [program, "train", "-d", source, "-o", folder, "--eval", "-q",
               "--seed", str(seed), *options]
    start = time.monotonic()
    subprocess.run(command, check=True)
    process = time.monotonic() - start
    metrics = json.loads((pathlib.Path(folder) / "metrics.json").read_text())
    kept = {"scene": scene, **{key: metrics[key] for key in KEPT if key in metrics}}
    kept["seconds"]["process"] = process
    return kept


def train(*run):
    """The same in a folder of its own, which goes again."""
    with tempfile.TemporaryDirectory() as folder:
        return train_into(folder, *run)


def run(arguments):
    runs = []
    for scene in arguments.scenes:
        for seed in arguments.seeds:
            runs.append(train(arguments.program, arguments.data, scene, seed, arguments.options))
            print(scene, seed, f"{runs[-1]['psnr']:.2f} dB", f"{runs[-1]['seconds']['train']:.1f} s", flush=True)
    result = {"bench": "scenes", "options": arguments.options, **environment(arguments.commit), "runs": runs}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")


def spread(values, form):
    middle = statistics.median(values)
    text = form.format(middle)
    return text if len(values) == 1 else f"{text} ({form.format(min(values))} to {form.format(max(values))})"


def on_cpu(runs):
    return runs[0]["device"].startswith("cpu")


def where(result):
    """The machine, commit and seeds of a result, in words."""
    runs = result["runs"]
    machine = [result["processor"].strip(), runs[0]["device"], result["compiler"]] if on_cpu(runs) else [
        result["gpu_and_driver"], result["nvcc"]]
    seeds = ", ".join(str(s) for s in sorted({r["seed"] for r in runs}))
    return f"{', '.join(machine)}, commit {result['commit']}, seeds {seeds}; median (least to most)"


def by(key, runs):
    """The runs with the same `key`, in the order of their first."""
    return {name: [r for r in runs if r[key] == name] for name in dict.fromkeys(r[key] for r in runs)}


def print_tables(key, runs):
    """One line for the runs of the same `key`: what they reached, and then their time by stage."""
    cpu = on_cpu(runs)
    print(f"| {key} | held-out PSNR, dB | SSIM | Gaussians | iterations per second | seconds | peak {'host' if cpu else 'device'} MiB |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name, same in by(key, runs).items():
        column = lambda pick, form: spread([pick(r) for r in same], form)
        print("|", " | ".join([name, column(lambda r: r["psnr"], "{:.2f}"), column(lambda r: r["ssim"], "{:.3f}"),
                               column(lambda r: r["gaussians"], "{:,.0f}"),
                               column(lambda r: r["iterations_per_second"], "{:.0f}"),
                               column(lambda r: r["seconds"]["train"], "{:.1f}"),
                               column(lambda r: r["peak_host_bytes" if cpu else "peak_device_bytes"] / 2**20, "{:.0f}")]), "|")
    print("\nMilliseconds of an iteration by stage\n")
    print(f"| {key} | " + " | ".join(runs[0]["stages"]) + " | all |")
    print("| --- |" + " --- |" * (len(runs[0]["stages"]) + 1))
    for name, same in by(key, runs).items():
        cells = [f"{statistics.median(r['stages'][s]['milliseconds'] for r in same):.3f}" for s in same[0]["stages"]]
        whole = statistics.median(1000 / r["iterations_per_second"] for r in same)
        print("|", " | ".join([name, *cells, f"{whole:.3f}"]), "|")


def table(arguments):
    result = json.loads(pathlib.Path(arguments.file).read_text())
    print(f"{arguments.title or '`' + ' '.join(result['options']) + '`, ' + where(result)}\n")
    print_tables("scene", result["runs"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run")
    runner.add_argument("--program", required=True)
    runner.add_argument("--data", default=".", help="folder of the scenes")
    runner.add_argument("--scenes", nargs="+", required=True)
    runner.add_argument("--seeds", nargs="+", type=int, default=[0])
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.add_argument("--title", help="line above the table (default: options, machine, commit and seeds)")
    shower.set_defaults(action=table)
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


if __name__ == "__main__":
    main()
