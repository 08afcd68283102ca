#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Compares drawings of our files by viewers of others with our own renders of the same files:

    draw.py PROGRAM MODEL.ply FOLDER SCREENSHOTS

MODEL.ply has z up and was trained with antialiasing. FOLDER contains the pages of viewers/ and
node_modules.

`convert --up z` turns the model upright, and each viewer has its usual up direction. So the image
of a viewer must also equal a render of MODEL.ply with z up, with the SH degree of the format.
Prints the lowest PSNR of three views for both. Fails if one is too low, if a viewer reads another
number of Gaussians, or if it reports a problem.
"""
import functools
import http.server
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import threading
import typing

TESTS = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(TESTS / "support"), str(TESTS / "gaussian_splatting/pages")]
from browser import Browser  # noqa: E402
from pages_in_browser import psnr, read_png  # noqa: E402

PROGRAM, MODEL, FOLDER, SCREENSHOTS = sys.argv[1], *map(pathlib.Path, sys.argv[2:])
WIDTH, HEIGHT, DEGREES = 480, 360, 40
# In the coordinates of the scene, with z up.
POSITIONS = ((2.3, -2.2, 1.3), (-2.9, -0.9, 0.9), (0.5, 2.9, 2.1))
TARGET = (0, 0, -0.1)
# three.js draws Gaussians only up to 2 standard deviations. The others must come closer, because
# a wrong sign of one SH coefficient of degree 3 can still leave more than 35 dB.
LEAST_PSNR = {"spark": 42, "babylon": 42, "three": 35}
# Viewers clamp the color of each Gaussian to 1, but the program clamps only the color of a pixel.
# Colors of a darker model need no clamping.
BRIGHTNESS = 0.6
SH_C0 = 0.28209479


class Drawing(typing.NamedTuple):
    file: str
    viewer: str
    y_down: bool = False  # whether the format has y down, so that viewers turn it
    antialiased: bool = True  # false if the format has no mark for it
    sh_degree: int = 3  # the highest of the format
    options: tuple = ()  # of `convert`


DRAWINGS = (
    Drawing("model.ply", "spark", y_down=True),
    Drawing("model.compressed.ply", "spark", y_down=True),
    Drawing("model.splat", "spark", y_down=True, antialiased=False, sh_degree=0),
    Drawing("model.sog", "spark", y_down=True),
    # Spark does not read version 4 of SPZ.
    Drawing("model3.spz", "spark", options=("--spz-version", "3")),
    Drawing("model3.spz", "babylon", options=("--spz-version", "3")),
    Drawing("model.spz", "babylon"),
    Drawing("model.glb", "babylon", antialiased=False),
    Drawing("model.spz", "three"),
    Drawing("model.glb", "three", antialiased=False),
)


def run(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments), "-q"], check=True)


def darker(model, output):
    """Writes a model with colors times BRIGHTNESS, and returns the number of its Gaussians."""
    header, end, body = model.read_bytes().partition(b"end_header\n")
    names = re.findall(rb"property float (\w+)", header)
    rows = struct.Struct(f"<{len(names)}f")
    gaussians = [list(row) for row in rows.iter_unpack(body)]
    for i, name in enumerate(names):
        offset = (BRIGHTNESS - 1) * 0.5 / SH_C0 if name.startswith(b"f_dc") else 0
        if name.startswith((b"f_dc", b"f_rest")):
            for g in gaussians:
                g[i] = BRIGHTNESS * g[i] + offset
    output.write_bytes(header + end + b"".join(rows.pack(*g) for g in gaussians))
    return len(gaussians)


def y_down(x, y, z):
    return x, -z, y


def y_up(x, y, z):
    return x, z, -y


def renders(model, axes, name):
    """Returns our renders. `axes` turns a vector of the scene to the axes of the model."""
    cameras = [{"position": axes(*p), "look_at": axes(*TARGET), "up": axes(0, 0, 1), "field_of_view": DEGREES}
               for p in POSITIONS]
    path = FOLDER / "cameras.json"
    path.write_text(json.dumps({"cameras": cameras, "width": WIDTH, "height": HEIGHT}))
    output = SCREENSHOTS / name
    shutil.rmtree(output, ignore_errors=True)
    run("render", model, "--path", path, "--seconds", len(cameras), "--fps", 1, "--device", "cpu", "-o", output)
    return [read_png(file) for file in sorted(output.iterdir())]


@functools.cache
def renders_of_scene(sh_degree):
    model = FOLDER / f"degree_{sh_degree}.ply"
    run("convert", FOLDER / "scene.ply", model, "--max-sh-degree", sh_degree)
    return renders(model, lambda *v: v, model.stem)


def drawn_by(d, address):
    """Returns the viewer's number of Gaussians, its images, and its problems."""
    images = []
    with Browser("chromium", seconds=300) as browser:
        browser.open(f"{address}/{d.viewer}.html", WIDTH, HEIGHT)
        browser.wait("window.ready === true")
        what = {"file": d.file, "yDown": d.y_down, "antialiased": d.antialiased}
        count = browser.evaluate(f"load({json.dumps(what)})")
        for i, position in enumerate(POSITIONS):
            view = {"position": y_up(*position), "target": y_up(*TARGET), "degrees": DEGREES}
            browser.evaluate(f"draw({json.dumps(view)})")
            image = SCREENSHOTS / f"{d.file}.{d.viewer}.{i}.png"
            browser.screenshot(image)
            images.append(read_png(image))
        return count, images, [p for p in browser.problems if not p.startswith("the page asks for " + address)]


def serve(folder):
    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}"


def main():
    address, failures = serve(FOLDER), []
    expected_count = darker(MODEL, FOLDER / "scene.ply")
    upright = FOLDER / "upright.ply"
    run("convert", FOLDER / "scene.ply", upright, "--up", "z")
    for d in DRAWINGS:
        run("convert", upright, FOLDER / d.file, *d.options)
        ours = renders(FOLDER / d.file, y_down, d.file)
        count, theirs, problems = drawn_by(d, address)
        of_file, of_scene = (min(map(psnr, expected, theirs)) for expected in (ours, renders_of_scene(d.sh_degree)))
        print(f"{d.file:20} {d.viewer:8} {of_file:.1f} dB to our render of the file, {of_scene:.1f} dB to the scene",
              flush=True)
        if min(of_file, of_scene) < LEAST_PSNR[d.viewer]:
            problems.append(f"less than {LEAST_PSNR[d.viewer]} dB")
        if count != expected_count:
            problems.append(f"{count} Gaussians instead of {expected_count}")
        failures += [f"{d.viewer}, {d.file}: {problem}" for problem in problems]
    if failures:
        sys.exit("\n".join(failures))
    print("all viewers agree")


main()
