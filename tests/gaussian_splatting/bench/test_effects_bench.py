#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""bench/effects.py: the tables that it makes of runs that are given."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "bench"))
import effects  # noqa: E402


def one(scene, options, seed=0, psnr=30.0, speed=1000.0, on=(), **more):
    """A run; `on`: the effects that it simulated, direction to degree 2."""
    names = ["direction", *effects.SCENES, "background"]
    found = [{"name": name, "on": name in on, **({"sh_degree": 2} if name == "direction" else {})} for name in dict.fromkeys(names)]
    return {"scene": scene, "options": options, "seed": seed, "psnr": psnr, "fitted_psnr": psnr + 1, "gaussians": 10,
            "iterations_per_second": speed, "device": "cuda, none", "peak_host_bytes": 7 * 2**20, "peak_device_bytes": 2 * 2**20,
            "effects": found, "from_distance": {str(d): psnr - d for d in effects.DISTANCES}, **more}


def result(changed=(), scenes=()):
    """All that a table needs, alike but for the runs that are `changed`."""
    pairs = [(scene, options) for effect, both in effects.SCENES.items() for scene in both
             for options in effects.selections(effect)]
    pairs += [(scene, options) for scene in (*effects.LITTLE, *effects.MUCH, *scenes) for options in effects.SELECTIONS]
    runs = {key: [one(*key)] for key in pairs}
    for run in changed:
        runs[run["scene"], run["options"]] = [r for r in changed if (r["scene"], r["options"]) == (run["scene"], run["options"])]
    return {"runs": [r for some in runs.values() for r in some], "scenes": list(scenes), "options": ["-i", "7"], "commit": "none",
            "gpu_and_driver": "a GPU", "nvcc": "nvcc", "compiler": "c++", "processor": "a CPU"}


def cells(text, first):
    [row] = [line for line in text.splitlines() if line.startswith(first)]
    return row.strip("| ").split(" | ")


class Tables(unittest.TestCase):
    def test_on_beside_off(self):
        called, _ = effects.SCENES["sky"]
        runs = [one(called, "none", psnr=20, speed=500), one(called, "sky", psnr=24.5, speed=400)]
        row = cells(effects.table(result(runs)), f"| `sky` | yes | `{called}`")
        self.assertEqual(row[3:6], ["1.25", "2, 2", "20.00, 24.50 (+4.50)"])
        self.assertEqual(row[6], "21.00, 25.50 (+4.50)")
        self.assertEqual(row[7:], [f"{20 - d:.2f}, {24.5 - d:.2f} (+4.50)" for d in effects.DISTANCES])

    def test_an_effect_that_needs_another_is_compared_with_it(self):
        called, _ = effects.SCENES["response"]
        runs = [one(called, "exposure", psnr=24), one(called, "exposure,response", psnr=26)]
        row = cells(effects.table(result(runs)), f"| `response` | yes | `{called}`")
        self.assertEqual(row[5], "24.00, 26.00 (+2.00)")

    def test_medians_of_seeds(self):
        called, _ = effects.SCENES["masks"]
        runs = [one(called, "masks", seed, psnr) for seed, psnr in enumerate((31, 37, 32))]
        row = cells(effects.table(result(runs)), f"| `masks` | yes | `{called}`")
        self.assertEqual(row[5], "30.00, 32.00 (+2.00)")

    def test_auto_beside_all_and_none(self):
        scene = effects.LITTLE[0]
        runs = [one(scene, "none", psnr=33, speed=900), one(scene, "auto", psnr=34, speed=800, on=("direction", "sky", "background")),
                one(scene, "all", psnr=32, speed=600)]
        row = cells(effects.table(result(runs)), f"| `{scene}` |")
        self.assertEqual(row[1:], ["direction 2, sky", "1.33", "0.89", "33.00 / 34.00 / 32.00", "34.00 / 35.00 / 33.00"])

    def test_nothing_is_simulated_and_photos_have_no_world(self):
        runs = [one("fern", options, from_distance=None) for options in effects.SELECTIONS]
        row = cells(effects.table(result(runs, ["fern"])), "| `fern` |")
        self.assertEqual(row[1], "nothing")

    def test_memory_of_a_cpu_is_the_host_s(self):
        self.assertEqual(effects.peak_mib(one("fern", "none", peak_device_bytes=0)), 7)


if __name__ == "__main__":
    unittest.main()
