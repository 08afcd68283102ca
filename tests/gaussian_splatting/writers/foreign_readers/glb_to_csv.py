#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Writes the Gaussians of a .glb file as CSV, with y down:

    glb_to_csv.py in.glb > out.csv

It follows the text of the extension KHR_gaussian_splatting, and shares no code with the trainer.
"""
import json
import math
import struct
import sys

data = open(sys.argv[1], "rb").read()
magic, version, size, json_size, json_type = struct.unpack_from("<4sIII4s", data)
assert (magic, version, size, json_type) == (b"glTF", 2, len(data), b"JSON")
document = json.loads(data[20:20 + json_size])
binary = data[28 + json_size:]
primitive = document["meshes"][0]["primitives"][0]
assert primitive["mode"] == 0 and "KHR_gaussian_splatting" in primitive["extensions"]


def rows(name):
    accessor = document["accessors"][primitive["attributes"][name]]
    assert accessor["componentType"] == 5126
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    view = document["bufferViews"][accessor["bufferView"]]
    flat = struct.unpack_from(f"<{width * accessor['count']}f", binary, view["byteOffset"])
    return [flat[i:i + width] for i in range(0, len(flat), width)]


def logit(p):
    p = min(max(p, 1e-7), 1 - 1e-7)
    return math.log(p / (1 - p))


prefix = "KHR_gaussian_splatting:"
sh = []
for degree in range(1, 4):
    for k in range(2 * degree + 1):
        name = f"{prefix}SH_DEGREE_{degree}_COEF_{k}"
        if name in primitive["attributes"]:
            sh.append(rows(name))
# A rotation by 180 degrees about x: signs of y and z, and of the harmonics that are odd in (y, z).
SIGNS = [-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1]
names = ["x", "y", "z", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3", "opacity", "f_dc_0",
         "f_dc_1", "f_dc_2"] + [f"f_rest_{k}" for k in range(3 * len(sh))]
print(",".join(names))
for i, (p, s, q, o, c) in enumerate(zip(rows("POSITION"), rows(prefix + "SCALE"), rows(prefix + "ROTATION"),
                                        rows(prefix + "OPACITY"), rows(prefix + "SH_DEGREE_0_COEF_0"))):
    rest = [SIGNS[k] * sh[k][i][channel] for channel in range(3) for k in range(len(sh))]
    values = [p[0], -p[1], -p[2], *map(math.log, s), q[3], q[0], -q[1], -q[2], logit(o[0]), *c, *rest]
    print(",".join(map(repr, values)))
