#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Checks reference_metrics.json, with which test_interior_ssim.cpp and test_lpips.cpp compare, against
scikit-image and PyTorch. Skips what is not installed. Exit code 77: nothing is installed.

    reference_metrics.py           # compares
    reference_metrics.py --write   # writes the file anew
"""
import importlib.util
import json
import math
import pathlib
import sys

FILE = pathlib.Path(__file__).with_suffix(".json")
SSIM_SIZES = ((37, 29), (11, 11), (64, 48))
LPIPS_SIZES = ((37, 29), (16, 16))


def interior_ssim():
    """The values of scikit-image, by size. For the masked images, the mean over windows without masked pixels."""
    from skimage.metrics import structural_similarity

    found = {}
    for width, height in SSIM_SIZES:
        render, target = (plane.astype("float64") for plane in patterns.images(width, height))
        value, windows = structural_similarity(render, target, channel_axis=0, data_range=1, gaussian_weights=True,
                                               sigma=1.5, use_sample_covariance=False, full=True)
        found[f"{width}x{height}"] = float(value)
    masked = patterns.mask(width, height)
    counted = [windows[:, y, x].mean() for y in range(5, height - 5) for x in range(5, width - 5)
               if not masked[y - 5:y + 6, x - 5:x + 6].any()]
    found[f"{width}x{height} masked"] = float(sum(counted) / len(counted))
    return found


def lpips():
    """The parts of the distance that come from each layer, by the number of black and the size. Computes in double
    precision, because convolutions in single precision differ between processors by more than the tolerance."""
    import torch

    weights = {name: torch.from_numpy(values).double() for name, values in patterns.lpips_weights().items()}
    shift = torch.tensor([-0.030, -0.088, -0.188], dtype=torch.double).view(1, 3, 1, 1)
    scale = torch.tensor([0.458, 0.448, 0.450], dtype=torch.double).view(1, 3, 1, 1)

    def features(planes, black):
        x = (black + (1 - black) * torch.from_numpy(planes).double()[None] - shift) / scale
        for layer, indices in enumerate(patterns.CONVOLUTIONS):
            if layer:
                x = torch.nn.functional.max_pool2d(x, 2)
            for index in indices:
                x = torch.nn.functional.conv2d(x, weights[f"features.{index}.weight"],
                                               weights[f"features.{index}.bias"], padding=1).relu()
            yield x / (x.square().sum(1, keepdim=True).sqrt() + 1e-10)

    found = {}
    for black in (-1, 0):
        for width, height in LPIPS_SIZES:
            render, target = patterns.images(width, height)
            pairs = zip(features(render, black), features(target, black))
            found[f"{black} {width}x{height}"] = [
                float(torch.nn.functional.conv2d((one - other).square(), weights[f"lin{layer}.model.1.weight"]).mean())
                for layer, (one, other) in enumerate(pairs)]
    return found


def differences(expected, found):
    for key in expected.keys() | found.keys():
        one, other = expected.get(key), found.get(key)
        pairs = zip(one, other) if isinstance(one, list) and isinstance(other, list) else [(one, other)]
        if not all(a and b and math.isclose(a, b, rel_tol=1e-9) for a, b in pairs):
            yield f"{key}: the file has {one}, but the reference computes {other}"


def main():
    kept = json.loads(FILE.read_text()) if FILE.exists() else {}
    wrong, checked = [], 0
    for metric, package, compute in (("interior_ssim", "skimage", interior_ssim), ("lpips", "torch", lpips)):
        if importlib.util.find_spec(package) is None:
            print(f"SKIPPED: {metric} is not checked, because the Python package {package} is not installed")
            continue
        found = compute()
        wrong += [f"{metric} {sentence}" for sentence in differences(kept.get(metric, {}), found)]
        kept[metric] = found
        checked += 1
    if "--write" in sys.argv[1:]:
        FILE.write_text(json.dumps(kept, indent=2) + "\n")
        return 0
    print("\n".join(wrong) or f"{checked} metrics agree with the reference")
    return 1 if wrong else 0 if checked else 77


if __name__ == "__main__":
    if importlib.util.find_spec("numpy") is None:
        print("SKIPPED: the Python package numpy is not installed")
        sys.exit(77)
    import patterns
    sys.exit(main())
