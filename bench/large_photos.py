#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Writes a COLMAP scene with any number of large photos, or compares streamed with resident photos.

    bench/large_photos.py make scene --photos 2000 --megapixels 12
    bench/large_photos.py compare scene PROGRAM --photo-memory 16GiB -- -i 3000 --max-cap 500000

The photos are JPEG files of a textured ground that cameras on a spiral look down on. `make` needs numpy
and Pillow (Debian: python3-numpy, python3-pil). `compare` trains twice, with resident photos
(--resident-memory, which must suffice for all of them) and with --photo-memory, and prints the seconds of
training, the share by which they differ, and the peaks of memory. Options after -- go to both trainings.
"""
import argparse
import json
import math
import multiprocessing
import pathlib
import struct
import subprocess
import sys
import tempfile

HEIGHT, RADIUS = 4.0, 6.0
PART = 1000000  # points that one process writes at once
BAND = 32  # rows of a photo that are computed at once, so that they stay in the cache


def colors(x, y):
    """Returns the color of the ground, three channels from 0 to 255."""
    import numpy as np
    channels = []
    for phase in (0.0, 2.1, 4.2):
        coarse = np.sin(1.3 * x + phase) * np.cos(1.7 * y - phase)
        fine = np.sin(23 * x + 11 * y) * np.sin(17 * y - 7 * x + phase)
        channels.append(128 + 70 * coarse + 50 * fine)
    return np.stack(channels, axis=-1).astype(np.uint8)


def camera(index, count):
    """Returns the world-to-camera rotation, by rows, and the center of the camera."""
    import numpy as np
    angle, far = 2.399963 * index, RADIUS * math.sqrt((index + 0.5) / count)
    center = np.array([far * math.cos(angle), far * math.sin(angle), HEIGHT])
    target = np.array([0.6 * center[0], 0.6 * center[1], 0.0])
    forward = (target - center) / np.linalg.norm(target - center)
    right = np.cross(forward, [math.sin(angle), -math.cos(angle), 0.3])
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward]), center


def quaternion(r):
    """Returns the quaternion (w, x, y, z) of a rotation."""
    import numpy as np
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], 0, 0, 0],
                  [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], 0, 0],
                  [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], 0],
                  [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]]]) / 3
    x, y, z, w = np.linalg.eigh(k)[1][:, 3]
    return w, x, y, z


def write_photo(job):
    import numpy as np
    from PIL import Image
    file, index, count, width, height = job
    rotation, center = camera(index, count)
    pixels = np.empty((height, width, 3), np.uint8)
    for top in range(0, height, BAND):
        rows = np.arange(top, min(top + BAND, height), dtype=np.float32)
        u, v = np.meshgrid((np.arange(width, dtype=np.float32) + 0.5 - width / 2) / width,
                           (rows + 0.5 - height / 2) / width)
        ray = [(rotation[0, k] * u + rotation[1, k] * v + rotation[2, k]).astype(np.float32) for k in range(3)]
        far = center[2] / np.maximum(-ray[2], 1e-3)
        pixels[top:top + len(rows)] = colors(center[0] + far * ray[0], center[1] + far * ray[1])
    Image.fromarray(pixels).save(file, quality=90)


def size_of(megapixels):
    """Returns the width and the height of the photos."""
    width = round(math.sqrt(megapixels * 1e6 * 4 / 3))
    return width, round(width * 3 / 4)


def make(args):
    width, height = size_of(args.megapixels)
    images, sparse = args.scene / "images", args.scene / "sparse" / "0"
    for folder in (images, sparse):
        folder.mkdir(parents=True, exist_ok=True)
    names = [f"{index:05d}.jpg" for index in range(args.photos)]
    with multiprocessing.Pool() as pool:
        jobs = [(images / name, index, args.photos, width, height) for index, name in enumerate(names)]
        for done, _ in enumerate(pool.imap_unordered(write_photo, jobs), 1):
            print(f"\r{done} of {args.photos} photos", end="", file=sys.stderr)
    print(file=sys.stderr)
    write_sparse(sparse, args, names, width, height)


def write_sparse(sparse, args, names, width, height):
    """Writes the cameras and the points in COLMAP's binary form, the points in parts."""
    import numpy as np
    with open(sparse / "cameras.bin", "wb") as file:
        pinhole = 1
        file.write(struct.pack("<QIiQQ4d", 1, 1, pinhole, width, height, width, width, width / 2, height / 2))
    with open(sparse / "images.bin", "wb") as file:
        file.write(struct.pack("<Q", len(names)))
        for index, name in enumerate(names):
            rotation, center = camera(index, args.photos)
            file.write(struct.pack("<I7dI", index + 1, *quaternion(rotation), *(-rotation @ center), 1))
            file.write(name.encode() + b"\0" + struct.pack("<Q", 0))
    file = sparse / "points3D.bin"
    file.write_bytes(struct.pack("<Q", args.points))
    parts = [(file, first, min(PART, args.points - first)) for first in range(0, args.points, PART)]
    with multiprocessing.Pool() as pool:
        pool.map(write_points, parts, chunksize=1)


def write_points(part):
    """Writes random points of the ground at their place in the file."""
    import numpy as np
    file, first, count = part
    record = np.dtype([("id", "<u8"), ("position", "<f8", 3), ("color", "u1", 3), ("error", "<f8"), ("tracks", "<u8")])
    points = np.zeros(count, record)
    place = np.random.default_rng(first).uniform(-1.5 * RADIUS, 1.5 * RADIUS, (count, 2))
    points["id"] = np.arange(first + 1, first + 1 + count)
    points["position"][:, :2] = place
    points["color"] = colors(place[:, 0], place[:, 1])
    points["error"] = 0.1
    with open(file, "r+b") as into:
        into.seek(8 + first * record.itemsize)
        points.tofile(into)


def train(args, memory, out):
    subprocess.run([args.program, "train", "-d", args.scene, "-o", out, "--overwrite", "--photo-memory", memory,
                    *args.options], check=True)
    return json.loads((pathlib.Path(out) / "metrics.json").read_text())


def compare(args):
    with tempfile.TemporaryDirectory() as folder:
        runs = {"resident": train(args, args.resident_memory, folder),
                "streamed": train(args, args.photo_memory, folder)}
    for name, run in runs.items():
        print(f"{name}: {run['seconds']['train']:.2f} s of training, {run['seconds']['load']:.2f} s of loading, "
              f"{run['peak_device_bytes'] / 1e9:.2f} GB of device memory, {run['peak_host_bytes'] / 1e9:.2f} GB of "
              f"host memory, {run['gaussians']} Gaussians")
    slower = runs["streamed"]["seconds"]["train"] / runs["resident"]["seconds"]["train"] - 1
    print(f"streamed photos take {100 * slower:+.1f} % of training time")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = words.add_subparsers(required=True)
    maker = commands.add_parser("make")
    maker.add_argument("scene", type=pathlib.Path)
    maker.add_argument("--photos", type=int, default=2000)
    maker.add_argument("--megapixels", type=float, default=12)
    maker.add_argument("--points", type=int, default=100000)
    maker.set_defaults(run=make)
    comparer = commands.add_parser("compare")
    comparer.add_argument("scene", type=pathlib.Path)
    comparer.add_argument("program", help="the trainer")
    comparer.add_argument("--photo-memory", required=True)
    comparer.add_argument("--resident-memory", default="1TB")
    comparer.set_defaults(run=compare)
    given = sys.argv[1:]
    end = given.index("--") if "--" in given else len(given)
    args = words.parse_args(given[:end])
    args.options = given[end + 1:]
    args.run(args)


if __name__ == "__main__":
    main()
