#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Tests scripts/convert_lpips_weights.py with random weights. Exit code 77: PyTorch is not installed."""
import importlib.util
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[3] / "scripts/convert_lpips_weights.py"


def convert(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, text=True)


class Conversion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.weights = patterns.lpips_weights()
        tensors = {name: torch.from_numpy(values) for name, values in cls.weights.items()}
        cls.network, cls.lpips = cls.folder / "vgg16.pth", cls.folder / "vgg.pth"
        # torchvision's file has more layers.
        others = {"classifier.0.bias": torch.zeros(3)}
        torch.save({**others, **{k: v for k, v in tensors.items() if k.startswith("features.")}}, cls.network)
        torch.save({k: v for k, v in tensors.items() if k.startswith("lin")}, cls.lpips)

    def test_the_file_contains_all_weights(self):
        output = self.folder / "converted.safetensors"
        for option, input_range in (([], "-1,1"), (["--inputs-from-0"], "0,1")):
            done = convert(self.network, self.lpips, output, *option)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            content = output.read_bytes()
            (length,) = struct.unpack_from("<Q", content)
            header, values = json.loads(content[8:8 + length]), content[8 + length:]
            self.assertEqual(header.pop("__metadata__")["input_range"], input_range)
            self.assertEqual(header.keys(), self.weights.keys())
            for name, entry in header.items():
                begin, end = entry["data_offsets"]
                self.assertEqual((entry["dtype"], tuple(entry["shape"])), ("F32", self.weights[name].shape))
                self.assertEqual(values[begin:end], self.weights[name].tobytes())
            self.assertEqual(sum(v.nbytes for v in self.weights.values()), len(values))

    def test_wrong_files_are_refused_and_nothing_is_written(self):
        text, output = self.folder / "text.pth", self.folder / "none.safetensors"
        text.write_text("not weights")
        for arguments, culprit in (((self.lpips, self.network), "features.0.weight"), ((text, self.lpips), "text.pth")):
            done = convert(*arguments, output)
            self.assertNotEqual(done.returncode, 0)
            self.assertTrue(done.stderr.startswith("error: "), done.stderr)
            self.assertIn(culprit, done.stderr)
            self.assertFalse(output.exists())


if __name__ == "__main__":
    if any(importlib.util.find_spec(package) is None for package in ("numpy", "torch")):
        print("SKIPPED: the Python packages numpy and torch are not installed")
        sys.exit(77)
    import patterns
    import torch
    unittest.main()
