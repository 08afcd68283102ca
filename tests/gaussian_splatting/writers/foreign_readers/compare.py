#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Compares two tables of Gaussians, the second of which was quantized by a format:

    compare.py expected.csv found.csv FORMAT

Prints a row with the largest error of each parameter. Fails if the number of Gaussians differs, or an error
exceeds the half step of the format. The order of the Gaussians may differ.
"""
import csv
import math
import sys

BYTE = 0.5 / 255
# Half steps of: position, log of scale, component of the rotation, opacity, f_dc, f_rest. None: not in the
# format, or without a bound for a single Gaussian. A share of the extent of the model in parentheses.
BOUNDS = {
    "ply": (0, 0, 1e-6, 1e-6, 0, 0),
    "compressed.ply": ((0.5 / 1023,), (0.5 / 1023,), 0.0021, BYTE, (BYTE,), 4 / 256),
    # A rotation of .splat may have one component of 1, which is stored as 127/128, beside rounded ones.
    "splat": (0, 1e-5, math.sqrt(1 + 3 * 0.25) / 128, BYTE, BYTE / 0.282, None),
    "spz": (0.5 / 4096, 0.5 / 16, 0.0021, BYTE, BYTE / 0.15, 1 / 128),
    "their spz": (0.5 / 4096, 0.5 / 16, 0.0021, BYTE, BYTE / 0.15, 8.5 / 128),
    "glb": (0, 1e-5, 1e-6, 1e-6, 0, 0),
    # A codebook is coarse where a model has few values.
    "sog": (1e-3, (8 / 256,), 0.0081, BYTE, (8 / 256,), None),
    # splat-transform rounds toward zero, so errors are up to a whole step.
    "their sog": (1e-3, (8 / 256,), 0.0162, 2 * BYTE, (8 / 256,), None),
}
# Formats clip values to a range: of log of scale, f_dc, f_rest.
UNLIMITED = (-math.inf, math.inf)
RANGES = {
    "splat": (UNLIMITED, (-0.5 / 0.28209479, 0.5 / 0.28209479), UNLIMITED),
    "spz": ((-10, 255 / 16 - 10), (-0.5 / 0.15, 0.5 / 0.15), (-1, 127 / 128)),
    "their spz": ((-10, 255 / 16 - 10), (-0.5 / 0.15, 0.5 / 0.15), (-1, 127 / 128)),
    "compressed.ply": ((-20, 20), UNLIMITED, (-4, 4)),
}
ROUNDING = 2e-6  # of floats and of their text
GROUPS = (("x", "y", "z"), ("scale_0", "scale_1", "scale_2"), ("rot_0", "rot_1", "rot_2", "rot_3"), ("opacity",),
          ("f_dc_0", "f_dc_1", "f_dc_2"))
LABELS = ("position", "log scale", "rotation", "opacity", "f_dc", "f_rest")


def table(file):
    with open(file, newline="") as lines:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(lines)]


def clip(gaussians, kind):
    ranges = RANGES.get(kind, (UNLIMITED,) * 3)
    for g in gaussians:
        for prefix, (low, high) in zip(("scale_", "f_dc_", "f_rest_"), ranges):
            for name in g:
                if name.startswith(prefix):
                    g[name] = min(max(g[name], low), high)


def unit(q):
    length = math.hypot(*q)
    return [x / length for x in q]


def alpha(logit):
    return 1 / (1 + math.exp(-min(max(logit, -500), 500)))


def errors_of(a, b, rest):
    errors = [max(abs(a[n] - b[n]) for n in names) for names in GROUPS]
    p, q = unit([a[n] for n in GROUPS[2]]), unit([b[n] for n in GROUPS[2]])
    sign = math.copysign(1, sum(x * y for x, y in zip(p, q)))
    errors[2] = max(abs(x - sign * y) for x, y in zip(p, q))
    errors[3] = abs(alpha(a["opacity"]) - alpha(b["opacity"]))
    return errors + [max((abs(a[n] - b.get(n, 0)) for n in rest), default=0)]


def pairs(expected, found, radius):
    """Pairs each Gaussian with the nearest one, within a grid of cells that are as wide as the radius."""
    cells = {}
    cell_of = lambda g: tuple(math.floor(g[n] / radius) for n in GROUPS[0])
    for g in found:
        cells.setdefault(cell_of(g), []).append(g)
    for g in expected:
        x, y, z = cell_of(g)
        near = [c for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)
                for c in cells.get((x + i, y + j, z + k), ())]
        if not near:
            sys.exit(f"no Gaussian near {[g[n] for n in GROUPS[0]]}")
        # Several Gaussians may be near each other: the most similar one counts.
        yield g, min(near, key=lambda c: sum(abs(g[n] - c[n]) for names in GROUPS for n in names if n != "opacity"))


def main():
    expected, found, kind = table(sys.argv[1]), table(sys.argv[2]), sys.argv[3]
    if len(expected) != len(found):
        sys.exit(f"{kind}: {len(found)} Gaussians instead of {len(expected)}")
    clip(expected, kind)
    extents = [max(max(g[n] for g in expected) - min(g[n] for g in expected) for n in names) for names in GROUPS]
    extents.append(0)
    bounds = [b[0] * e if isinstance(b, tuple) else b for b, e in zip(BOUNDS[kind], extents)]
    rest = [n for n in expected[0] if n.startswith("f_rest")]
    worst = [0.0] * 6
    for a, b in pairs(expected, found, max(2 * bounds[0], 1e-4)):
        worst = [max(w, e) for w, e in zip(worst, errors_of(a, b, rest))]
    print(f"{kind:15}" + "".join(f" {label} {error:.2g}" for label, error in zip(LABELS, worst)))
    for label, error, bound in zip(LABELS, worst, bounds):
        if bound is not None and error > bound + ROUNDING:
            sys.exit(f"{kind}: the error of {label}, {error:.3g}, exceeds {bound:.3g}")


main()
