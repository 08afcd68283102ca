#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""bench/fronts.py: runs of stand-ins for trainers, whose figures follow from their options, and what it makes of them."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[3] / "bench"
sys.path.insert(0, str(BENCH))
import fronts  # noqa: E402

# A trainer that knows only the options that all trainers know. It writes its command line to calls.txt, fails
# once after as many calls as fail.txt contains, and refuses to train beside a training whose time counts.
# With a limit of Gaussians and pair.txt, it waits until another training with a limit has begun.
TRAINER = """
import argparse, json, pathlib, sys, time
here = pathlib.Path(__file__).resolve().parent
parser = argparse.ArgumentParser(allow_abbrev=False)
parser.add_argument("command", choices=["train"])
for name in ("-d", "-o", "--seed", "-i", "--max-cap", "--device"):
    parser.add_argument(name)
parser.add_argument("--eval", action="store_true", required=True)
parser.add_argument("-q", action="store_true")
given = parser.parse_args()
with (here / "calls.txt").open("a") as calls:
    calls.write(" ".join([pathlib.Path(sys.argv[0]).name, *sys.argv[1:]]) + "\\n")
fail = here / "fail.txt"
if fail.exists() and len((here / "calls.txt").read_text().splitlines()) > int(fail.read_text()):
    fail.unlink()
    sys.exit(3)
timed = here / "timed"
if given.max_cap is None:
    timed.mkdir()
elif timed.exists():
    sys.exit("a timed training runs")
if given.max_cap and (here / "pair.txt").exists():
    deadline = time.monotonic() + 60
    while sum("--max-cap" in line for line in (here / "calls.txt").read_text().splitlines()) < 2:
        if time.monotonic() > deadline:
            sys.exit("no other training began")
        time.sleep(0.01)
seconds = int(given.i) / (100 if "older" in sys.argv[0] else 200)
metrics = {"psnr": 20 + seconds, "gaussians": int(given.max_cap or 7), "seconds": {"train": seconds}, "device": "cpu, 8 lanes"}
(pathlib.Path(given.o) / "metrics.json").write_text(json.dumps(metrics))
if given.max_cap is None:
    timed.rmdir()
"""


def given(seeds=(0, 1, 2), programs=("now", "before")):
    """A result whose older program takes twice the time for 1 dB less."""
    budgets = {"seconds": (400, 200), "gaussians": (1000, 2000)}
    runs = [{"front": front, "scene": scene, "seed": seed, "budget": budget, "program": name,
             "seconds": budget / (200 if name == "now" else 100), "gaussians": budget, "device": "cuda, a GPU",
             "psnr": 20 + budget / 1000 - (name == "before") + [0, 0.5, 0.125][seed]}
            for front in budgets for scene in ("lego", "fern") for seed in seeds for budget in budgets[front] for name in programs]
    about = {"commit": "new", "before_commit": "old" if "before" in programs else None, "processor": " a CPU",
             "gpu_and_driver": "a GPU, 5.8"}
    return {"about": about, "runs": runs}


def python_with_matplotlib():
    """A Python that can draw, or None: this one or Debian's."""
    for python in sys.executable, "/usr/bin/python3":
        if subprocess.run([python, "-c", "import matplotlib"], capture_output=True).returncode == 0:
            return python
    return None


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "fronts.json"
        for name in "newer", "older":
            program = self.folder / name
            program.write_text(f"#!{sys.executable} -IS\n{TRAINER}")
            program.chmod(0o755)

    def calls(self):
        return (self.folder / "calls.txt").read_text().splitlines()

    def run_fronts(self, *more, seeds=(0,), before=True):
        older = ["--before", self.folder / "older", "--before-commit", "old"] if before else []
        words = ["run", "--program", self.folder / "newer", *older, "--data", "scenes", "--scenes", "lego", "fern", "--seeds",
                 *map(str, seeds), "--iterations", "400", "200", "--max-cap", "1000", "--output", self.file, "--commit", "new", *more]
        return subprocess.run([sys.executable, BENCH / "fronts.py", *words], capture_output=True, text=True)

    def result(self, *more, **options):
        done = self.run_fronts(*more, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(self.file.read_text())

    def test_programs_take_turns_with_each_budget(self):
        result = self.result("--", "--device", "cpu")
        self.assertEqual([(r["front"], r["budget"], r["program"]) for r in result["runs"] if r["scene"] == "fern"],
                         [("seconds", 400, "now"), ("seconds", 400, "before"), ("seconds", 200, "now"), ("seconds", 200, "before"),
                          ("gaussians", 1000, "now"), ("gaussians", 1000, "before")])
        first, *_, last = self.calls()
        self.assertRegex(first, "^newer train -d scenes/lego -o .* --eval -q --seed 0 --device cpu -i 400$")
        self.assertRegex(last, "^older train -d scenes/fern -o .* --eval -q --seed 0 --device cpu -i 7000 --max-cap 1000$")
        self.assertEqual(result["runs"][1], {"front": "seconds", "scene": "lego", "seed": 0, "budget": 400, "program": "before",
                                             "seconds": 4.0, "psnr": 24.0, "gaussians": 7, "device": "cpu, 8 lanes"})

    def test_stopped_run_goes_on(self):
        (self.folder / "fail.txt").write_text("4")
        failed = self.run_fronts()
        self.assertEqual(failed.returncode, 1)
        self.assertRegex(failed.stderr, "^error: exit status 3 of .*/newer train -d scenes/fern .* -i 400\n$")
        self.assertEqual(len(json.loads(self.file.read_text())["runs"]), 4)
        keys = [fronts.key_of(r) for r in self.result()["runs"]]
        self.assertEqual(len(keys), 12)
        self.assertEqual(len(set(keys)), 12)
        self.assertEqual(len(self.calls()), 13)  # all once, and the failure

    def test_longer_lists_add_trainings(self):
        self.result()
        self.assertEqual(len(self.result(seeds=(0, 2))["runs"]), 24)
        self.assertEqual(len(self.calls()), 24)

    def test_results_of_something_else_are_refused(self):
        self.result()
        for what, words in {"commit": ["--commit", "newer"], "before_commit": ["--before-commit", "older"],
                            "options": ["--", "--device", "cpu"]}.items():
            refused = self.run_fronts(*words)
            self.assertEqual(refused.returncode, 1)
            self.assertEqual(refused.stderr, f"error: {self.file} has results of another {what}; pass --fresh to discard them\n")
        self.assertEqual(len(self.calls()), 12)
        result = self.result("--commit", "newer", "--fresh")
        self.assertEqual((result["about"]["commit"], len(result["runs"]), len(self.calls())), ("newer", 12, 24))

    def test_only_the_second_front_trains_at_the_same_time(self):
        (self.folder / "pair.txt").touch()
        self.assertEqual(len(self.result("--jobs", "2")["runs"]), 12)

    def test_older_program_needs_its_commit(self):
        refused = self.run_fronts("--before-commit", "old", before=False)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--before and --before-commit belong together", refused.stderr)


class Tables(unittest.TestCase):
    def test_captions_name_the_seeds_of_each_program_if_they_differ(self):
        result = given()
        result["runs"] = [r for r in result["runs"] if r["program"] == "now" or r["seed"] == 1]
        self.assertIn("commits new (now) and old (before), seeds 0, 1, 2 (now) and 1 (before); median", fronts.tables(result))

    def test_medians_of_seeds(self):
        text = fronts.tables(given())
        self.assertIn("Budgets of iterations; a GPU, driver 5.8, commits new (now) and old (before), seeds 0, 1, 2; median (least to most)\n\n"
                      "| scene | iterations | seconds, now | seconds, before | PSNR, now | PSNR, before | Gaussians, now | Gaussians, before |\n",
                      text)
        self.assertIn("| lego | 200 | 1.00 (1.00 to 1.00) | 2.00 (2.00 to 2.00) | 20.32 (20.20 to 20.70) | 19.32 (19.20 to 19.70) | "
                      "200 (200 to 200) | 200 (200 to 200) |\n| lego | 400 |", text)
        self.assertIn("Limits of Gaussians, 7,000 iterations; a GPU,", text)
        self.assertIn("| fern | 1,000 | 21.12 (21.00 to 21.50) | 20.12 (20.00 to 20.50) | 1,000 (1,000 to 1,000) | 1,000 (1,000 to 1,000) |", text)

    def test_one_program_has_columns_of_its_own(self):
        result = given((0,), ("now",))
        for run in result["runs"]:
            run["device"] = "cpu, 8 lanes"
        text = fronts.tables(result)
        self.assertIn("; a CPU, commit new, seeds 0; median", text)
        self.assertIn("| scene | iterations | seconds, now | PSNR, now | Gaussians, now |\n", text)
        self.assertIn("| lego | 200 | 1.00 | 20.20 | 200 |\n", text)

    def test_budget_without_older_training_is_empty(self):
        result = given((0,))
        result["runs"] = [r for r in result["runs"] if (r["budget"], r["program"]) != (400, "before")]
        self.assertIn("| lego | 400 | 2.00 |  | 20.40 |  | 400 |  |\n", fronts.tables(result))


class Pictures(unittest.TestCase):
    def setUp(self):
        self.python = python_with_matplotlib()
        if self.python is None:
            self.skipTest("matplotlib is not installed")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def pictures(self, result):
        """The two files by front, drawn from a result."""
        file = self.folder / "fronts.json"
        file.write_text(json.dumps(result))
        subprocess.run([self.python, BENCH / "fronts.py", "plot", file, self.folder / "picture"], check=True)
        return {front: (self.folder / f"picture_{front}.svg").read_text() for front in fronts.FRONTS}

    def curve(self, svg, name):
        """The vertices of a curve, or None if the picture has no such curve."""
        found = re.search(rf'<g id="{name}">\s*<path d="([^"]*)"', svg)
        return found and [tuple(map(float, point.split())) for point in re.split("[ML]", found.group(1))[1:]]

    def test_both_show_each_scene_and_program(self):
        result = given()
        pictures = self.pictures(result)
        self.assertEqual(pictures, self.pictures(result))  # the same bytes
        for front, svg in pictures.items():
            for text in ("lego", "fern", "now", "before", "held-out PSNR, dB", fronts.FRONTS[front]["axis"],
                         "a GPU, driver 5.8, commits new (now) and old (before), seeds 0, 1, 2"):
                self.assertIn(f">{text}<", svg)
            self.assertNotIn("<dc:date>", svg)
            for name in "lego now", "lego before", "fern now", "fern before":
                self.assertEqual(len(self.curve(svg, name)), 2, f"{front}: {name}")

    def test_curves_are_medians_at_their_places(self):
        result = given()
        curve = {name: self.curve(self.pictures(result)["seconds"], f"lego {name}") for name in ("now", "before")}
        (x0, y0), (x1, y1) = curve["now"]
        (u0, v0), (u1, v1) = curve["before"]
        octave = x1 - x0  # 1 and 2 seconds, and before 2 and 4, on a logarithmic axis
        self.assertAlmostEqual(u0, x1, 3)
        self.assertAlmostEqual(u1 - u0, octave, 3)
        decibel = v0 - y0  # down is less
        self.assertAlmostEqual((y0 - y1) / decibel, 0.2, 3)
        # The mean would rise by a third of this, and the median rises to the next seed's PSNR.
        for run in result["runs"]:
            run["psnr"] += 5 * (run["seed"] == 2 and run["budget"] == 200 and run["program"] == "now")
        other = {name: self.curve(self.pictures(result)["seconds"], f"lego {name}") for name in ("now", "before")}
        lift = (other["before"][0][1] - other["now"][0][1]) / (other["before"][0][1] - other["before"][1][1])
        self.assertAlmostEqual(lift, (20.7 - 19.325) / 0.2, 2)

    def test_one_program_has_one_curve(self):
        for svg in self.pictures(given(programs=("now",))).values():
            self.assertIsNone(self.curve(svg, "lego before"))
            self.assertNotIn(">before<", svg)
            self.assertIsNotNone(self.curve(svg, "lego now"))


if __name__ == "__main__":
    unittest.main()
