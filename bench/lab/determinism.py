#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Whether training repeats: the hashes of the .ply that several runs from one seed end in.

    bench/lab/determinism.py --program build/cuda/.../gaussian_splatting --data ../shared/data --scenes lego truck --runs 5 \\
        --output bench/results/determinism.json -- -i 7000 --device cuda --deterministic

With --threads the runs have these numbers of threads in turn, on a CPU. Exits with 1 where a scene has several hashes.
"""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))  # bench
from environment import environment, own_and_passed_on  # noqa: E402


def hash_of(arguments, scene, options, threads):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([arguments.program, "train", "-d", str(pathlib.Path(arguments.data) / scene), "-o", folder, "-q",
                        "--seed", str(arguments.seed), *options], check=True,
                       env={**os.environ, **({"OMP_NUM_THREADS": str(threads)} if threads else {})})
        plys = sorted(pathlib.Path(folder).glob("point_cloud/*/point_cloud.ply"))
        return hashlib.sha256(b"".join(p.read_bytes() for p in plys)).hexdigest()


def main():
    own, passed = own_and_passed_on()
    options = passed[0] if passed else []
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--data", required=True)
    parser.add_argument("--scenes", nargs="+", required=True)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--threads", nargs="+", type=int, default=[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--commit", help="where the sources are no git checkout")
    parser.add_argument("--output", required=True)
    arguments = parser.parse_args(own)
    hashes = {}
    for scene in arguments.scenes:
        turns = [arguments.threads[k % len(arguments.threads)] for k in range(arguments.runs)]
        hashes[scene] = [hash_of(arguments, scene, options, threads) for threads in turns]
        print(f"{scene}: {len(set(hashes[scene]))} of {arguments.runs} runs, {hashes[scene][0][:12]}", flush=True)
    result = {"bench": "determinism", **environment(arguments.commit), "seed": arguments.seed, "threads": arguments.threads,
              "options": options, "hashes": hashes}
    pathlib.Path(arguments.output).write_text(json.dumps(result, indent=1) + "\n")
    return 1 if any(len(set(h)) > 1 for h in hashes.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
