#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Builds the trainer once more for each knob in its kernels: with what kernel_knobs.toml says changed in a copy of the
sources. bench/lab/tradeoff.py measures what comes of it beside its own knobs:

    bench/lab/kernel_knobs.py build --output build/knobs -- -DWARPAGG_CUDA=ON -DCMAKE_CUDA_ARCHITECTURES=90
    bench/lab/tradeoff.py run --kernels build/knobs --program build/bench/bench/lab/lab ...
    bench/lab/kernel_knobs.py check        # that every place of an edit is marked in the sources, and no other

The options after -- are CMake's. A build a knob, all at once.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import source_marks  # noqa: E402
from environment import own_and_passed_on  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRAINER = pathlib.Path("examples") / "gaussian_splatting"
PARTS = ["CMakeLists.txt", "cmake", "include", "examples"]


def knobs():
    """By name, what each changes: (what it means, its edits)."""
    listed = tomllib.loads((ROOT / "bench" / "lab" / "kernel_knobs.toml").read_text())["knob"]
    return {k["name"]: (k["what"], k["edit"]) for k in listed}


def program_of(folder, name):
    return pathlib.Path(folder) / re.sub(r"\W+", "_", name) / "gaussian_splatting"


def programs_in(folder):
    """Those that were built there, by the name of the knob."""
    return {name: str(program_of(folder, name)) for name in knobs() if program_of(folder, name).exists()}


def apply(edits, sources):
    """Edits the trainer in a copy of the project."""
    places = source_marks.find_marks(sources / TRAINER, "knob")
    for file in {places[e["at"]] for e in edits}:
        here = [e for e in edits if places[e["at"]] == file]
        file.write_text(source_marks.edited(file.read_text(), "knob", here))


def check():
    places = source_marks.find_marks(ROOT / TRAINER, "knob")
    source_marks.check(places, [e["at"] for _, edits in knobs().values() for e in edits], "knob")


def build(output, name, edits, options, jobs):
    folder = program_of(output, name).parent
    sources = folder / "sources"
    shutil.rmtree(folder, ignore_errors=True)
    sources.mkdir(parents=True)
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, sources / part)
    apply(edits, sources)
    for command in (["cmake", "-S", sources, "-B", folder / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                     "-DWARPAGG_TESTS=OFF", "-DWARPAGG_CPU_LEVELS=OFF", *options],
                    ["ninja", "-C", folder / "build", f"-j{jobs}", "gaussian_splatting"]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{name} does not build:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    shutil.move(folder / "build" / TRAINER / "gaussian_splatting", program_of(output, name))
    shutil.rmtree(folder / "build")
    shutil.rmtree(sources)


def build_all(output, options, some):
    chosen = {name: edits for name, (_, edits) in knobs().items() if not some or name in some}
    jobs = max(1, len(os.sched_getaffinity(0)) // len(chosen) + 1)
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        list(pool.map(lambda knob: build(output, *knob, options, jobs), chosen.items()))


def main():
    own, passed_on = own_and_passed_on()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    builder = commands.add_parser("build")
    builder.add_argument("--output", required=True, help="a folder for the programs")
    builder.add_argument("--only", nargs="+", default=[], choices=knobs(), help="these alone")
    builder.set_defaults(action=lambda a: build_all(a.output, passed_on[0] if passed_on else [], a.only))
    commands.add_parser("check").set_defaults(action=lambda _: check())
    arguments = parser.parse_args(own)
    try:
        arguments.action(arguments)
    except source_marks.MarkError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    sys.exit(main())
