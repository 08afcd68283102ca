#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""How a training on a CPU gains by threads: the same one with each number of them, in turn.

    bench/threads.py run --program build/release/.../gaussian_splatting --data ../shared/data/lego --threads 1 2 4 8 16 \\
        --output bench/results/threads.json -- -r 4 -i 7000
    bench/threads.py table bench/results/threads.json

Iterations per second, of the fastest of the rounds, the ratio to that of the first number of threads, and each stage's.
"""
import argparse
import json
import os
import pathlib

from environment import environment, own_and_passed_on
from scenes import by, train


def run(arguments):
    runs = []
    data = pathlib.Path(arguments.data)
    for _ in range(arguments.rounds):
        for threads in arguments.threads:
            os.environ["OMP_NUM_THREADS"] = str(threads)
            one = train(arguments.program, data.parent, data.name, 0, [*arguments.options, "--device", "cpu"])
            runs.append({"threads": threads, **one})
            print(threads, f"{one['iterations_per_second']:.1f} it/s", f"{one['psnr']:.2f} dB", flush=True)
    fastest = [max(same, key=lambda r: r["iterations_per_second"]) for same in by("threads", runs).values()]
    for row in fastest:
        row["ratio"] = row["iterations_per_second"] / fastest[0]["iterations_per_second"]
    result = {"bench": "threads", "options": arguments.options, "rounds": arguments.rounds,
              "processors": len(os.sched_getaffinity(0)), **environment(arguments.commit), "rows": fastest}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")
    show(result)


def show(result):
    rows = result["rows"]
    stages = list(rows[0]["stages"])
    print(f"\n{rows[0]['scene']}, `{' '.join(result['options'])}`, {result['processor'].strip()}, {result['processors']} "
          f"processors, commit {result['commit']}, the fastest of {result['rounds']}\n")
    print(f"| threads | it/s | times as fast | loop, s | held-out PSNR, dB | {' | '.join(stages)} |")
    print("| --- |" + " --- |" * (len(stages) + 4))
    for row in rows:
        gains = [f"{rows[0]['stages'][s]['milliseconds'] / row['stages'][s]['milliseconds']:.1f}×" for s in stages]
        print(f"| {row['threads']} | {row['iterations_per_second']:.0f} | {row['ratio']:.1f}× | "
              f"{row['seconds']['train']:.1f} | {row['psnr']:.2f} | {' | '.join(gains)} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    runner = commands.add_parser("run", help="after --: options of the training")
    runner.add_argument("--program", required=True)
    runner.add_argument("--data", required=True, help="the scene")
    runner.add_argument("--threads", nargs="+", type=int, default=[1, 2, 4, 8, 16])
    runner.add_argument("--rounds", type=int, default=1)
    runner.add_argument("--commit", help="where the sources are no git checkout")
    runner.add_argument("--output", required=True)
    runner.set_defaults(action=run)
    shower = commands.add_parser("table")
    shower.add_argument("file")
    shower.set_defaults(action=lambda arguments: show(json.loads(pathlib.Path(arguments.file).read_text())))
    own, passed_on = own_and_passed_on()
    arguments = parser.parse_args(own)
    arguments.options = passed_on[0] if passed_on else []
    arguments.action(arguments)


main()
