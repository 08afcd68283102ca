#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""bench/decisions.py: what it makes of decisions that are given, and a run of the program $WARPAGG_PROGRAM."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[3] / "bench"
SCRIPT = [sys.executable, BENCH / "decisions.py"]
sys.path.insert(0, str(BENCH))
import decisions  # noqa: E402

COLOUR = "direction"


def told(case, **color):
    """The run of a scene of which all is decided right but its color, as said."""
    effects = {name: {"recommended": has, "evidence": "seen"} for name, has in case["truth"].items()}
    effects[COLOUR].update(color)
    return {**case, "effects": effects, "seconds": 0.5}


def mixtures(*pairs):
    """With gloss or not, and whether color is called for."""
    return [told(decisions.synthetic("mixture", "spheres", {"gloss": 0.5} if has else {}), recommended=recommended)
            for has, recommended in pairs]


class Arithmetic(unittest.TestCase):
    def row(self, runs, noise="0"):
        """Precision, recall, and the counts of color."""
        pure = [told(decisions.synthetic("pure", "alpha", {}), recommended=None, evidence="cannot decide: 7 points")]
        real = [{**pure[0], "kind": "real", "scene": "lego", "truth": None}]
        result = {"runs": [*pure, *runs, *real], "seed": 3, "processor": " a CPU", "compiler": "c++", "commit": "none"}
        self.text = decisions.tables(result)
        [found] = [line for line in self.text.splitlines() if line.startswith(f"| {COLOUR} | {noise} | ")]
        return found.strip("| ").split(" | ")[2:]

    def test_precision_and_recall(self):
        given = mixtures((True, True), (True, True), (True, True), (True, False), (True, None), (False, True), (False, False))
        self.assertEqual(self.row(given), ["75 %", "60 %", "3", "1", "2"])  # undecided is a miss
        self.assertEqual(decisions.counts(given, COLOUR), (3, 1, 2))

    def test_without_positives_there_is_no_share(self):
        self.assertEqual(self.row(mixtures((False, False), (False, None))), ["none", "none", "0", "0", "0"])
        self.assertEqual(self.row(mixtures((True, False))), ["none", "0 %", "0", "0", "1"])
        self.assertEqual(self.row(mixtures((False, True))), ["0 %", "none", "0", "1", "0"])

    def test_noises_are_told_apart(self):
        noisy = told(decisions.synthetic("mixture", "spheres", {"gloss": 1, "noise": 0.1}))
        runs = [*mixtures((True, False)), noisy]
        self.assertEqual(self.row(runs, "0"), ["none", "0 %", "0", "0", "1"])
        self.assertEqual(self.row(runs, "0.1"), ["100 %", "100 %", "1", "0", "0"])

    def test_misses_have_their_evidence(self):
        glossy = decisions.synthetic("mixture", "spheres", {"gloss": 0.4})
        self.row([told(glossy, recommended=None, evidence="cannot decide: 9 points")])
        self.assertIn("| `alpha` | right: undecided |" + " right: no |" * 11 + " right: yes |", self.text)
        self.assertIn(f"| `spheres,gloss=0.4` | {COLOUR} | undecided | 9 points |", self.text)
        self.assertIn("| lego | undecided: 7 points |" + " no: seen |" * 11 + " yes: seen | 0.50 |", self.text)


    def test_what_decisions_cost(self):
        judged = [{**one, "psnr": {"automatic": automatic, "with": 30.0, "without": 31.0}}
                  for one, automatic in zip(mixtures((True, True), (True, False)), (30.5, 31.25))]
        text = "\n".join(decisions.judgment(COLOUR, judged))
        self.assertIn("| 0 | automatic | 2 | 50 % | 0.12 | 0.50 |", text)
        self.assertIn("| 0 | with | 2 | 0 % | 1.00 | 1.00 |", text)
        self.assertIn("| 0 | without | 2 | 100 % | 0.00 | 0.00 |", text)

    def test_refined_poses_are_judged(self):
        self.assertEqual(decisions.psnr({"psnr": 20}), 20)
        self.assertEqual(decisions.psnr({"psnr": 20, "refined_psnr": 30}), 30)


class Mixtures(unittest.TestCase):
    def test_seed_says_all(self):
        some = decisions.mixtures(20, 0, [0, 0.01])
        self.assertEqual(some, decisions.mixtures(20, 0, [0, 0.01]))
        self.assertNotEqual(some, decisions.mixtures(20, 1, [0, 0.01]))
        self.assertEqual(some[:10], decisions.mixtures(5, 0, [0, 0.01]))
        self.assertEqual([c["truth"] for c in some[::2]], [c["truth"] for c in some[1::2]])

    def test_truth_is_what_the_scene_is_made_with(self):
        for case in decisions.mixtures(50, 0, [0.01]):
            for effect, cause in decisions.CAUSES.items():
                shows = effect != "response" or ",exposure=" in case["scene"]
                self.assertEqual(case["truth"][effect], f",{cause}=" in case["scene"] and shows)
            self.assertEqual(case["truth"]["background"], case["scene"].startswith("synthetic:alpha"))
            self.assertTrue(case["scene"].endswith(",noise=0.01"))


class Program(unittest.TestCase):
    def test_run_and_table(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "decisions.json"
            run = [*SCRIPT, "run", "--program", os.environ["WARPAGG_PROGRAM"], "--mixtures", "1", "--noises", "0.01",
                   "--commit", "none", "--output", file]
            subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
            self.assertEqual(os.listdir(folder), ["decisions.json"])
            result = json.loads(file.read_text())
            text = subprocess.run([*SCRIPT, "table", file], check=True, capture_output=True, text=True).stdout
        self.assertEqual([r["kind"] for r in result["runs"]], ["pure"] * 29 + ["mixture"])
        for one in result["runs"]:
            self.assertEqual(list(one["effects"]), list(one["truth"]))
        self.assertIn("| `alpha,exposure=0.3` | right: no | right: no | right: yes |" + " right: no |" * 9 + " right: yes |", text)
        self.assertIn("| `spheres,walls=0.8` |" + " right: no |" * 13, text)
        self.assertNotIn("Photos", text)

    def test_decisions_of_a_training(self):
        program = os.environ["WARPAGG_PROGRAM"]
        metrics = decisions.trained(program, "synthetic:spheres,exposure=0.3,views=16", ["-i", "20", "--device", "cpu"])
        found = decisions.decisions_of(metrics)
        self.assertTrue(found["exposure"]["recommended"])
        self.assertFalse(found["masks"]["recommended"])
        self.assertNotIn("background", found)
        self.assertIn("differs by", found["exposure"]["evidence"])
        with self.assertRaisesRegex(SystemExit, "train failed with synthetic:spheres: .*iterations"):
            decisions.trained(program, "synthetic:spheres", ["-i", "none"])

    def test_what_is_wrong_is_said_in_a_sentence(self):
        def refusal(*words):
            done = subprocess.run([*SCRIPT, *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            return done.stderr

        program = os.environ["WARPAGG_PROGRAM"]
        with tempfile.TemporaryDirectory() as folder:
            file = f"{folder}/x.json"
            run = ["run", "--output", file, "--program"]
            self.assertEqual(refusal(*run, "nothing"), "'nothing' does not run: No such file or directory\n")
            self.assertEqual(refusal(*run, program, "--scenes", "lego"),
                             "--data is the folder of the --scenes: one is not without the other\n")
            self.assertEqual(refusal(*run, program, "--data", folder, "--scenes", "lego"), f"there is no folder '{folder}/lego'\n")
            self.assertEqual(refusal(*run, program, "--mixtures", "-1"), "--mixtures is a number of scenes, not -1\n")
            self.assertEqual(refusal("table", file), f"'{file}' holds no result of bench/decisions.py\n")
            self.assertEqual(refusal("run", "--program", program, "--output", f"{folder}/no/x.json"),
                             f"there is no folder '{folder}/no'\n")
            self.assertEqual(os.listdir(folder), [])
        done = subprocess.run([*SCRIPT, "run", "--program", program, "--judge", "sky", "--output", file], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--judge compares trainings: give --train", done.stderr)
        with self.assertRaisesRegex(SystemExit, "inspect failed with synthetic:cubes: .*there is no synthetic scene 'cubes'"):
            decisions.inspect(program, "synthetic:cubes")


if __name__ == "__main__":
    unittest.main()
