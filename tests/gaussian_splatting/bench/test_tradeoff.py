#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""bench/lab/tradeoff.py: what it makes of runs whose figures are given, and a run of the program $WARPAGG_LAB."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[3] / "bench"
sys.path.insert(0, str(BENCH))
from lab import tradeoff  # noqa: E402


def runs(**figures):
    """Of each knob (ratio, PSNR) by seed."""
    return [{"options": name, "seed": seed, "ratio": ratio, "psnr": psnr, "seconds": {"train": ratio}}
            for name, same in figures.items() for seed, (ratio, psnr) in enumerate(same)]


GIVEN = runs(default=[(1, 30.0), (1, 30.2)], again=[(0.96, 30.0), (1.05, 30.5)], half=[(0.5, 28.1), (0.5, 28.1)],
             double=[(2, 32.1), (2, 32.1)], fixed=[(1.3, 30.0), (1.4, 30.1)], exact=[(0.9, 30.15), (0.94, 30.25)],
             fast=[(0.6, 30.0), (0.6, 30.0)], same=[(0.7, 30.1), (1.1, 30.6)], again_but_slow=[(1.02, 29.0), (1.1, 29.2)])


class Points(unittest.TestCase):
    def setUp(self):
        self.points = {p["name"]: p for p in tradeoff.points(GIVEN)}

    def test_front_has_no_point_that_another_beats_in_both(self):
        self.assertEqual([name for name, p in self.points.items() if p["front"]], ["half", "double", "exact", "fast"])

    def test_what_gains_nothing_beyond_the_spread_is_not_on_the_front(self):
        self.assertEqual([name for name, p in self.points.items() if not p["better"]], ["again", "fixed", "same", "again_but_slow"])

    def test_spread_is_that_of_the_default_and_of_itself_again(self):
        beyond = {name: self.points[name]["beyond"] for name in ("fixed", "exact", "fast", "again_but_slow")}
        self.assertEqual(beyond, {"fixed": ["ratio"], "exact": ["ratio"], "fast": ["ratio"], "again_but_slow": ["psnr"]})

    def test_one_seed_has_no_spread(self):
        one = tradeoff.points([r for r in GIVEN if r["seed"] == 0])
        self.assertEqual([p["beyond"] for p in one], [[]] * len(one))

    def test_length_of_a_run_is_what_a_knob_has_to_beat(self):
        self.assertAlmostEqual(self.points["half"]["above_length"], 0)
        self.assertAlmostEqual(self.points["fixed"]["above_length"], 30.05 - (30.1 + 2 * 0.43296), 4)  # 1.35 = 2^0.43296
        self.assertEqual(tradeoff.paying(GIVEN), ["fast", "exact"])
        lengths = [self.points[name] for name in ("half", "default", "double")]
        self.assertIsNone(tradeoff.after_that_time(lengths, 0.49))
        self.assertIsNone(tradeoff.after_that_time(lengths, 2.01))


class Together(unittest.TestCase):
    def test_what_sets_the_same_option_or_is_refused_together_is_not_combined(self):
        some = tradeoff.together(["pruned more", "no direction", "degree 2", "deterministic", "exact"], 700)
        self.assertEqual(list(some), ["pruned more + no direction", "pruned more + no direction + deterministic",
                                      "pruned more + no direction + deterministic + half", "pruned more + no direction + deterministic + double"])
        self.assertEqual(tradeoff.words(some["pruned more + no direction"]), ["--prune-share", "0.4", "--sh-degree", "0"])

    def test_iterations_follow_the_length(self):
        self.assertEqual(tradeoff.together(["not coarse to fine"], 700)["not coarse to fine + double"]["-i"], ["1400"])
        self.assertEqual(tradeoff.together(["fast"], 700)["fast + double"]["-i"], ["1000"])


@unittest.skipUnless("WARPAGG_LAB" in os.environ, "the lab is built with WARPAGG_BENCH")
class Program(unittest.TestCase):
    def test_run_and_table(self):
        script = [sys.executable, BENCH / "lab" / "tradeoff.py"]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tradeoff.json"
            run = [*script, "run", "--program", os.environ["WARPAGG_LAB"], "--data", "synthetic:spheres", "--knobs", "fixed",
                   "double", "--commit", "none", "--output", file, "--", "--iterations=20", "-r", "16", "--device", "cpu"]
            subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
            result = json.loads(file.read_text())
            text = subprocess.run([*script, "table", file], check=True, capture_output=True, text=True).stdout
        iterations = {r["options"]: r["iterations"] for r in result["runs"]}
        self.assertEqual(iterations, {"default": 20, "again": 20, "fixed": 20, "double": 40})
        name = pathlib.Path(os.environ["WARPAGG_LAB"]).name
        self.assertIn(f"{name} train -d synthetic:spheres -o OUTPUT --eval -i 40 -r 16 --device cpu  # double", text)


if __name__ == "__main__":
    unittest.main()
