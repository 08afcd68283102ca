# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Images and weights that patterns.hpp generates with the same bits."""
import numpy as np

DEPTHS = (64, 128, 256, 512, 512)
CONVOLUTIONS = ((0, 2), (5, 7), (10, 12, 14), (17, 19, 21), (24, 26, 28))


def uniform(count, seed):
    """Numbers in [0, 1), multiples of 2^-24."""
    x = np.arange(count, dtype=np.uint32) * np.uint32(0x9E3779B9) + np.uint32(seed)
    for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B)):
        x = (x ^ (x >> np.uint32(shift))) * np.uint32(factor)
    x ^= x >> np.uint32(16)
    return (x >> np.uint32(8)).astype(np.float64) * 2.0 ** -24


def images(width, height):
    """A render and its target, as three planes of float32: squares of 4x4 pixels and noise."""
    channel, row, column = np.indices((3, height, width))
    squares = uniform(3 * 64 * 64, 1)[(channel * 64 + row // 4) * 64 + column // 4]
    noise = uniform(3 * height * width, 2).reshape(3, height, width)
    target = (0.75 * squares + 0.25 * noise).astype(np.float32)
    error = uniform(3 * height * width, 3).reshape(3, height, width)
    return (0.875 * target.astype(np.float64) + 0.125 * error).astype(np.float32), target


def mask(width, height):
    """Whether a pixel is masked: one rectangle at the top, and a single pixel."""
    row, column = np.indices((height, width))
    return ((row < 4) & (column >= 20) & (column < 24)) | ((row == 20) & (column == 3))


def lpips_weights():
    """All tensors of LPIPS by name."""
    tensors, depth, seed = {}, 3, 100
    for layer, (to, layers) in enumerate(zip(DEPTHS, CONVOLUTIONS)):
        for index in layers:
            bound = np.sqrt(6 / (9 * depth))
            weights = (2 * uniform(to * depth * 9, seed) - 1) * bound
            tensors[f"features.{index}.weight"] = weights.astype(np.float32).reshape(to, depth, 3, 3)
            tensors[f"features.{index}.bias"] = (0.25 * uniform(to, seed + 1) - 0.125).astype(np.float32)
            depth, seed = to, seed + 2
        tensors[f"lin{layer}.model.1.weight"] = uniform(to, seed).astype(np.float32).reshape(1, to, 1, 1)
        seed += 1
    return tensors
