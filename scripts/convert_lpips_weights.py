#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Writes the published weights of LPIPS (VGG16, version 0.1) as a safetensors file for --lpips.

    scripts/convert_lpips_weights.py vgg16-397923af.pth vgg.pth lpips.safetensors

The first file contains the weights of torchvision's VGG16 that were trained on ImageNet. The second one is
weights/v0.1/vgg.pth of the Python package lpips. Needs PyTorch, on Debian: apt-get install python3-torch
"""
import argparse
import json
import os
import pathlib
import struct
import sys

DEPTHS = (64, 128, 256, 512, 512)
CONVOLUTIONS = ((0, 2), (5, 7), (10, 12, 14), (17, 19, 21), (24, 26, 28))


def shapes():
    """Name and shape of each tensor of the network, and of each tensor of LPIPS."""
    network, lpips, depth = {}, {}, 3
    for layer, (to, indices) in enumerate(zip(DEPTHS, CONVOLUTIONS)):
        for index in indices:
            network[f"features.{index}.weight"] = (to, depth, 3, 3)
            network[f"features.{index}.bias"] = (to,)
            depth = to
        lpips[f"lin{layer}.model.1.weight"] = (1, to, 1, 1)
    return network, lpips


def read(file, expected):
    """The float32 values of these tensors in a file of PyTorch, as little-endian bytes."""
    import torch

    try:
        found = torch.load(file, map_location="cpu", weights_only=True)
    except Exception as problem:  # torch.load raises various types
        sys.exit(f"error: cannot read {file} as weights of PyTorch: {problem}")
    tensors = {}
    for name, shape in expected.items():
        if name not in found:
            sys.exit(f"error: {file} has no tensor {name}: check that it is the right file")
        if tuple(found[name].shape) != shape:
            sys.exit(f"error: {file}: the tensor {name} has the shape {tuple(found[name].shape)} instead of {shape}")
        tensors[name] = found[name].to(torch.float32).contiguous().numpy().astype("<f4").tobytes()
    return tensors


def write(file, tensors, all_shapes, input_range):
    header, at = {"__metadata__": {"format": "pt", "input_range": input_range}}, 0
    for name, values in tensors.items():
        header[name] = {"dtype": "F32", "shape": all_shapes[name], "data_offsets": [at, at + len(values)]}
        at += len(values)
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    temporary = pathlib.Path(f"{file}.part")
    try:
        with open(temporary, "wb") as out:
            out.write(struct.pack("<Q", len(text)) + text)
            for values in tensors.values():
                out.write(values)
        os.replace(temporary, file)
    except OSError as problem:
        temporary.unlink(missing_ok=True)
        sys.exit(f"error: cannot write {file}: {problem.strerror}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("network", help="torchvision's weights of VGG16 (.pth)")
    parser.add_argument("lpips", help="weights of the linear layers of LPIPS (.pth)")
    parser.add_argument("output", help="the file to write (.safetensors)")
    parser.add_argument("--inputs-from-0", action="store_true",
                        help="lets the network see images with values from 0 to 1, as the reference implementation of "
                             "3D Gaussian splatting and gsplat do; otherwise -1 to 1, as the authors of LPIPS specify")
    options = parser.parse_args()
    network, lpips = shapes()
    tensors = {**read(options.network, network), **read(options.lpips, lpips)}
    write(options.output, tensors, {**network, **lpips}, "0,1" if options.inputs_from_0 else "-1,1")


if __name__ == "__main__":
    main()
