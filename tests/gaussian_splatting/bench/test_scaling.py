#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""bench/scaling.py: its formula of exchanged bytes, its fit of times that are given, and runs of the program
$WARPAGG_PROGRAM on the CPU."""
import contextlib
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BENCH = pathlib.Path(__file__).resolve().parents[3] / "bench"
SCRIPT = BENCH / "scaling.py"
sys.path.insert(0, str(BENCH))
import scaling  # noqa: E402


def python_with(*packages):
    """A Python with these packages, or None: this one or Debian's."""
    for python in sys.executable, "/usr/bin/python3":
        if subprocess.run([python, "-c", f"import {', '.join(packages)}"], capture_output=True).returncode == 0:
            return python
    return None


# The times of a machine without noise: 2 ms per step, 3 ns per pixel, 1 ns per Gaussian, 100 GB/s and 30 µs.
TERMS = [2e-3, 3e-9, 1e-9, 1e-11, 3e-5]


def given(ranks=(1, 2), terms=TERMS):
    """A result in which half of the Gaussians are visible, and times follow from the terms."""
    runs = []
    for megapixels, height in (1, 866), (4, 1732), (9, 2598):
        for points in 500_000, 1_000_000, 4_000_000:
            for count in ranks:
                pixels, splats = height * height * 4 // 3, points / 2
                moved = scaling.sent_splats(splats, 3, height, count)
                sent = {**scaling.bytes_of_step(moved, height, count, 4), "gaussians": 7.2 * points * (count - 1) / count}
                parts = [1, pixels / count, points / count, sum(sent.values()), 5 * (count > 1)]
                exchange = {"visible_splats": splats, "sent_splats": moved, "bytes": sent} if count > 1 else None
                runs.append({"megapixels": megapixels, "points": points, "ranks": count, "repeat": 0, "pixels": pixels,
                             "height": height, "seconds": sum(p * t for p, t in zip(parts, terms)), "gaussians": points,
                             "device": "cuda, a GPU", "accumulator": "native", "exchange": exchange})
    about = {"commit": "new", "device": "cuda", "processor": " a CPU", "gpu_and_driver": "a GPU, 5.8"}
    return {"about": about, "runs": runs}


class Formula(unittest.TestCase):
    def test_bytes_by_purpose(self):
        self.assertEqual(scaling.bytes_of_step(1000, 100, 4, 4), {"splats": 60240, "lists": 96, "gradients": 48000})
        self.assertEqual(scaling.bytes_of_step(1000, 96, 2, 8), {"splats": 60048, "lists": 56, "gradients": 96000})
        self.assertEqual(set(scaling.bytes_of_step(0, 96, 1, 8).values()), {0})

    def test_splats_go_to_the_strips_that_list_them(self):
        self.assertEqual(scaling.sent_splats(1000, 3, 160, 2), 1000 * 1.3 / 4)
        self.assertEqual(scaling.sent_splats(1000, 3, 160, 1), 0)
        self.assertEqual(scaling.sent_splats(1000, 3, 16, 4), 1000 * 3 / 4)  # all strips list all splats
        for ranks in 2, 3, 8:
            run = {"ranks": ranks, "height": 1000,
                   "exchange": {"visible_splats": 500, "sent_splats": scaling.sent_splats(500, 4, 1000, ranks)}}
            self.assertAlmostEqual(scaling.rows_of_splats(run), 4)

    def test_table_shows_differences(self):
        result = given()
        self.assertEqual(scaling.traffic_table(result).count("+0.000 %"), 27)
        for run in result["runs"]:
            if run["exchange"]:
                run["exchange"]["bytes"]["lists"] *= 1.5
        text = scaling.traffic_table(result)
        self.assertEqual((text.count("+0.000 %"), text.count("+50.000 %")), (18, 9))
        self.assertIn("| 999,941 | 500,000 | 2 GPUs | splats | 3,954,593 | 3,954,593 | +0.000 % |", text)

    def test_repeats_count_as_their_median(self):
        runs = given()["runs"]
        more = [{**run, "repeat": k, "seconds": run["seconds"] * factor} for run in runs for k, factor in ((1, 1.25), (2, 9))]
        self.assertEqual([run["seconds"] for run in scaling.medians(runs + more)],
                         [1.25 * run["seconds"] for run in scaling.medians(runs)])

    def test_first_report_is_left_out(self):
        history = {"iteration": [100, 200, 250], "seconds": [9, 10, 10.5]}
        self.assertEqual(scaling.seconds_per_step({"history": history}), 0.01)
        history = {"iteration": [50], "seconds": [9]}
        self.assertEqual(scaling.seconds_per_step({"history": history, "seconds": {"train": 5}, "iterations": 50}), 0.1)


class Prediction(unittest.TestCase):
    def setUp(self):
        self.python = python_with("numpy")
        if self.python is None:
            self.skipTest("numpy is not installed")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def predict(self, result, *options):
        file = self.folder / "scaling.json"
        file.write_text(json.dumps(result))
        return subprocess.run([self.python, SCRIPT, "predict", file, *options], capture_output=True, text=True)

    def rows(self, *arguments):
        done = self.predict(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.text = done.stdout
        return [[cell.strip() for cell in line.split("|")[1:-1]] for line in self.text.splitlines() if line.startswith("| ")][2:]

    def test_fit_finds_the_terms(self):
        rows = self.rows(given())
        self.assertIn("Fit: 2 ms per step, 3 ns per pixel, 1 ns per Gaussian, bandwidth 100 GB/s, 30 µs per exchange; "
                      "a view shows 50 % of the Gaussians; largest error ", self.text)
        # 3,999,765 pixels and 4,000,000 Gaussians on 8 GPUs: 2 + 1.5 + 0.5 + 0.28 + 0.25 + 0.15 ms, against 18 on one.
        self.assertIn(["3,999,765", "4,000,000", "8 devices", "", "4.68 (prediction)", "3.84 (prediction)"], rows)
        self.assertIn(["3,999,765", "4,000,000", "1 GPU", "18 (measured)", "18 (fit)", "1.00 (fit)"], rows)

    def test_all_predicted_figures_are_labeled(self):
        rows = self.rows(given())
        predicted = [row for row in rows if "GPU" not in row[2]]
        self.assertEqual((len(rows), len(predicted)), (9 * 5, 9 * 3))
        for row in predicted:
            self.assertEqual(row[3], "")
            self.assertTrue(all(cell.endswith(" (prediction)") for cell in row[4:]), row)
        self.assertIn("A prediction is no measurement", self.text)
        self.assertIn("The trainer does not support several nodes", self.text)

    def test_nodes_depend_on_their_network(self):
        def times(*options):
            return [float(row[4].split()[0]) for row in self.rows(given(), *options) if "nodes" in row[2]]
        for fast, slow in zip(times("--node-bandwidth", "400"), times("--node-bandwidth", "10")):
            self.assertLess(fast, slow)
        fast = [row for row in self.rows(given(), "--node-latency", "0", "--node-bandwidth", "1e9") if row[1] == "4,000,000"]
        # With a network that costs nothing, a view each takes the time of the GPUs of one node.
        self.assertEqual({row[4] for row in fast if row[2] == "8 nodes of 8, a view each"},
                         {row[4] for row in fast if row[2] == "8 devices"})

    def test_no_term_is_negative(self):
        self.rows(given(terms=[2e-3, 3e-9, -1e-10, 1e-11, 3e-5]))
        self.assertIn(" 0 ns per Gaussian,", self.text)

    def test_one_rank_needs_assumptions(self):
        refused = self.predict(given(ranks=(1,)))
        self.assertEqual(refused.returncode, 1)
        self.assertRegex(refused.stderr, "^error: the file has no training with several ranks.*--ranks 1 2.*\n$")
        rows = self.rows(given(ranks=(1,)), "--bandwidth", "100", "--latency", "30", "--visible", "0.5")
        self.assertIn(["3,999,765", "4,000,000", "8 devices", "", "4.68 (prediction)", "3.84 (prediction)"], rows)

    def test_more_ranks_are_used(self):
        self.assertEqual(len(self.rows(given(ranks=(1, 2, 4)))), 9 * 6)
        self.assertIn("bandwidth 100 GB/s, 30 µs per exchange", self.text)


class Pictures(unittest.TestCase):
    def setUp(self):
        self.python = python_with("matplotlib", "numpy")
        if self.python is None:
            self.skipTest("matplotlib or numpy is not installed")

    def test_predictions_are_labeled_and_measurements_are_not(self):
        with tempfile.TemporaryDirectory() as folder:
            file, measured, predicted = (pathlib.Path(folder) / name for name in ("scaling.json", "m.svg", "p.svg"))
            file.write_text(json.dumps(given()))
            subprocess.run([self.python, SCRIPT, "plot", file, measured], check=True)
            subprocess.run([self.python, SCRIPT, "predict", file, "--picture", predicted], check=True, capture_output=True)
            measured, predicted = measured.read_text(), predicted.read_text()
        self.assertNotIn("prediction", measured)
        for svg in measured, predicted:
            for text in "pixels of a photo", "Gaussians", "milliseconds per step", "a GPU, driver 5.8, commit new":
                self.assertIn(f">{text}<", svg)
        for name in "1 GPU", "2 GPUs":
            self.assertEqual(len(re.findall(rf'<g id="pixels: {name}, \d+">', measured)), 3)
            self.assertEqual(len(re.findall(rf'<g id="gaussians: {name}, \d+">', measured)), 3)
        legend = re.findall(r">([^<>]*(?:GPUs?|devices|nodes)[^<>]*), [^<>]*(?:Gaussians|pixels)<", predicted)
        self.assertEqual(len(legend), 2 * (2 + 3))
        for name in legend:
            self.assertEqual("prediction" in name, "GPU" not in name, name)


class Measurement(unittest.TestCase):
    def setUp(self):
        self.python = python_with("numpy", "PIL")
        if self.python is None or "WARPAGG_PROGRAM" not in os.environ:
            self.skipTest("numpy or Pillow is not installed, or WARPAGG_PROGRAM is not set")

    def test_program_exchanges_the_bytes_of_the_formula(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scaling.json"
            def run(*more):
                command = [self.python, SCRIPT, "measure", "--program", os.environ["WARPAGG_PROGRAM"], "--folder", folder,
                           "--megapixels", "0.003", "--gaussians", "300", "--photos", "4", "--device", "cpu", "--iterations", "4",
                           "--commit", "none", "--output", file, *more, "--", "--effects", "none"]
                done = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                return done.stdout.count("ms per step"), json.loads(file.read_text())
            self.assertEqual(run("--ranks", "1", "2")[0], 2)
            count, result = run("--ranks", "1", "2", "3")  # goes on with the third
        self.assertEqual(count, 1)
        self.assertEqual([(r["ranks"], r["gaussians"], r["pixels"], r["height"]) for r in result["runs"]],
                         [(ranks, 300, 63 * 47, 47) for ranks in (1, 2, 3)])
        self.assertIsNone(result["runs"][0]["exchange"])
        for run in result["runs"][1:]:
            exchange = run["exchange"]
            formula = scaling.bytes_of_step(exchange["sent_splats"], 47, run["ranks"], 4)
            for purpose, expected in formula.items():
                self.assertAlmostEqual(exchange["bytes"][purpose], expected, 6)
            self.assertEqual([exchange["calls"][purpose] for purpose in formula], [2, 1, 1])
        self.assertEqual(scaling.traffic_table(result).count("+0.000 %"), 6)


class Ranks(unittest.TestCase):
    def test_machine_without_gpus_has_no_ranks_of_gpus(self):
        before = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", before)
        with tempfile.TemporaryDirectory() as folder:
            os.environ["PATH"] = folder
            with self.assertRaisesRegex(SystemExit, "^error: this machine has 0 GPUs: give fewer --ranks, or --device cpu$"):
                scaling.present_ranks("cuda", [1, 2])
            self.assertEqual(scaling.present_ranks("cpu", [1, 2]), [1, 2])
            tool = pathlib.Path(folder) / "nvidia-smi"
            tool.write_text("#!/bin/sh\necho 'GPU 0: one'\necho 'GPU 1: two'\n")
            tool.chmod(0o755)
            with contextlib.redirect_stdout(io.StringIO()) as said:
                self.assertEqual(scaling.present_ranks("cuda", [1, 2, 4]), [1, 2])
            self.assertEqual(said.getvalue(), "left out: --ranks 4, because this machine has 2 GPUs\n")


if __name__ == "__main__":
    unittest.main()
