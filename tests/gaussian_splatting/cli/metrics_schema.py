#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Validates files that the program $WARPAGG_PROGRAM writes against docs/reference/metrics.schema.json. Exit code 77:
the Python package jsonschema is not installed."""
import importlib.util
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCHEMA = ROOT / "docs/reference/metrics.schema.json"
SCENE = ["-d", "synthetic:spheres", "-r", "32", "--device", "cpu"]
sys.path.insert(0, str(ROOT / "scripts"))
import convert_lpips_weights  # noqa: E402


def write_zero_weights(file):
    """A file for --lpips, with which all distances are 0."""
    network, lpips = convert_lpips_weights.shapes()
    shapes = {**network, **lpips}
    values = {name: bytes(4 * math.prod(shape)) for name, shape in shapes.items()}
    convert_lpips_weights.write(file, values, shapes, "-1,1")


class Schema(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        schema = json.loads(SCHEMA.read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        self.validator = jsonschema.Draft202012Validator(schema)

    def run_program(self, *arguments):
        """The content of metrics.json, which is valid."""
        done = subprocess.run([os.environ["WARPAGG_PROGRAM"], *arguments, "-o", self.folder], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        metrics = json.loads((self.folder / "metrics.json").read_text())
        self.validator.validate(metrics)
        return metrics

    def test_all_outputs_are_valid(self):
        weights = self.folder / "weights.safetensors"
        write_zero_weights(weights)
        self.assertIsNone(self.run_program("train", "-i", "20", *SCENE)["psnr"])
        further = ["--eval", "--fit-exposure", "--lpips", weights]
        poses = ["--effects", "auto,+poses"]
        shared = self.run_program("train", "--overwrite", "-i", "20", "--ranks", "2", *SCENE)
        self.assertFalse(self.validator.is_valid({**shared, "exchange": {**shared["exchange"], "bytes": {}}}))
        trained = self.run_program("train", "--overwrite", "-i", "60", "--test-iterations", "20", "--deterministic", *poses, *further, *SCENE)
        model = self.folder / "point_cloud/iteration_60/point_cloud.ply"
        evaluated = self.run_program("evaluate", model, *further, *SCENE)
        self.assertNotIn("lpips", self.run_program("evaluate", model, *SCENE))
        for metrics in (trained, evaluated):
            self.assertEqual((metrics["lpips"], metrics["lpips_input_range"]), (0, [-1, 1]))
            self.assertEqual(len(metrics["views"]), 8)
            self.assertIn("fitted_psnr", metrics)
            self.assertEqual("refined_psnr" in metrics, metrics is trained)
            self.check_that_fields_are_needed_and_known(metrics)

    def check_that_fields_are_needed_and_known(self, metrics):
        self.assertFalse(self.validator.is_valid({**metrics, "unknown": 1}))
        for field in metrics.keys() - {"lpips", "fitted_psnr", "refined_psnr"}:
            with self.subTest(field=field):
                self.assertFalse(self.validator.is_valid({k: v for k, v in metrics.items() if k != field}))
                self.assertFalse(self.validator.is_valid({**metrics, field: {"unknown": 1}}))


if __name__ == "__main__":
    if importlib.util.find_spec("jsonschema") is None:
        print("SKIPPED: the Python package jsonschema is not installed")
        sys.exit(77)
    import jsonschema
    unittest.main()
