#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Opens the pages that the program $WARPAGG_PROGRAM writes in the browser $WARPAGG_CHROMIUM, without a window.

Compares the viewer with the program's own renders of the same model. With $WARPAGG_SCREENSHOTS, keeps screenshots in
that folder."""
import base64
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from browser import Browser, require_browser  # noqa: E402

SCENE = ["-d", "synthetic:spheres,views=9", "-r", "96"]
EFFECTS_SCENE = ["-d", "synthetic:spheres,sky=0.7,scales=4,gloss=1,views=9", "-r", "64"]
EVIDENCE_SCENE = "synthetic:spheres,sky=0.7,exposure=0.3,gloss=0.6,scales=4,passers=0.1,depths=0.05,views=12"
SIZES = {"desktop": (1280, 800, 1, False), "phone": (390, 844, 2, True)}
# Software draws many frames of moving cameras, so their windows are small.
SMALL, SMALL_TOUCH = (320, 240, 1, False), (240, 320, 1, True)
COMPLETE = "document.documentElement.dataset.state === 'complete'"


def read_png(file):
    """Returns width, height and the rows of an 8-bit RGB or RGBA image, as bytes of RGB."""
    data, at, chunks = pathlib.Path(file).read_bytes(), 8, {}
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunks[kind] = chunks.get(kind, b"") + data[at + 8:at + 8 + size]
        at += size + 12
    width, height, depth, color = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert depth == 8 and color in (2, 6)
    channels = 3 if color == 2 else 4
    raw, stride, rows = zlib.decompress(chunks[b"IDAT"]), width * channels, []
    above = bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        above = unfiltered(raw[start], bytearray(raw[start + 1:start + 1 + stride]), above, channels)
        rows.append(bytes(value for i, value in enumerate(above) if i % channels < 3))
    return width, height, rows


def unfiltered(kind, row, above, channels):
    for i in range(len(row)):
        left = row[i - channels] if i >= channels else 0
        corner = above[i - channels] if i >= channels else 0
        up = above[i]
        if kind == 4:
            paeth = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
        row[i] = row[i] + (0, left, up, (left + up) // 2, paeth if kind == 4 else 0)[kind] & 255
    return row


def psnr(a, b):
    assert a[:2] == b[:2], f"{a[:2]} and {b[:2]} pixels"
    pairs = [(x, y) for p, q in zip(a[2], b[2]) for x, y in zip(p, q)]
    error = sum((x - y) ** 2 for x, y in pairs) / len(pairs)
    return 10 * math.log10(255 ** 2 / error) if error else math.inf


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.shots = os.environ.get("WARPAGG_SCREENSHOTS")
        cls.run_program("train", "-i", "200", "--device", "cpu", "-o", cls.folder / "run", *SCENE)
        cls.run_program("train", "-i", "150", "--device", "cpu", "--effects", "sky,antialiasing,direction",
                        "--sh-degree-interval", "10", "--sh-lr", "0.03", "-o", cls.folder / "effects", *EFFECTS_SCENE)
        cls.run_program("train", "-i", "100", "--device", "cpu", "--eval", "-o", cls.folder / "held_out", *SCENE)
        cls.run_program("train", "-i", "120", "--device", "cpu", "--eval", "-o", cls.folder / "longer", *SCENE)
        cls.run_program("inspect", "--html", cls.folder / "inspect.html", "-d", EVIDENCE_SCENE)
        cls.run_program("compare", cls.folder / "held_out", cls.folder / "longer", "-o", cls.folder / "compare.html")

    @classmethod
    def run_program(cls, *arguments):
        subprocess.run([os.environ["WARPAGG_PROGRAM"], *arguments], check=True, stdout=subprocess.DEVNULL)

    def setUp(self):
        self.browser = Browser(os.environ["WARPAGG_CHROMIUM"])
        self.addCleanup(self.browser.__exit__)

    def open(self, name, size, fragment=""):
        self.browser.open((self.folder / name).as_uri() + fragment, *size)

    def check_quiet(self):
        self.assertEqual(self.browser.problems, [])

    def keep_screenshot(self, name):
        """Makes an image for people to look at, if they want one."""
        if self.shots:
            self.browser.screenshot(pathlib.Path(self.shots) / (name + ".png"), whole=True)

    def renders_of_viewer_model(self, run, scene):
        """The program's renders of the model in the page, from all training views."""
        page = (self.folder / run / "viewer.html").read_text()
        model = self.folder / "embedded.compressed.ply"
        model.write_bytes(b"".join(base64.b64decode(part)
                                   for part in re.findall(r'class="splat">([^<]*)<', page)))
        self.run_program("render", model, "-o", self.folder / run / "renders", "--device", "cpu", *scene)
        return sorted((self.folder / run / "renders").iterdir())

    def check_view(self, run, view, expected):
        """Compares a view of the viewer with a render, and returns the image of the viewer."""
        self.browser.call("Page.navigate", url="about:blank")
        self.open(run + "/viewer.html", (*expected[:2], 1, False), f"#view={view}&ui=0")
        self.browser.wait(COMPLETE)
        self.browser.screenshot(self.folder / "view.png")
        found = read_png(self.folder / "view.png")
        self.assertGreater(psnr(expected, found), 45)
        return found

    def test_the_viewer_draws_what_the_program_draws(self):
        renders = self.renders_of_viewer_model("run", SCENE)
        for view in (0, 5):
            expected = read_png(renders[view])
            found = self.check_view("run", view, expected)
            # The scene is asymmetric: a turned image is far from it.
            self.assertLess(psnr(expected, (*found[:2], found[2][::-1])), 25)
        self.check_quiet()

    def test_the_viewer_draws_sky_and_antialiasing_and_view_dependent_colors(self):
        scene = json.loads(re.search('id="scene">(.*?)</script>', (self.folder / "effects/viewer.html").read_text())[1])
        self.assertTrue(scene["antialiased"])
        self.assertEqual(len(scene["sky"]), 48)
        renders = self.renders_of_viewer_model("effects", EFFECTS_SCENE)
        self.check_view("effects", 3, read_png(renders[3]))
        self.check_quiet()

    def test_the_viewer_works_on_each_size_of_screen(self):
        for name, size in SIZES.items():
            with self.subTest(name):
                self.open("run/viewer.html", size)
                self.browser.wait(COMPLETE)
                self.assertEqual(self.browser.evaluate("document.getElementById('canvas').width"), size[0] * size[2])
                self.assertFalse(self.browser.evaluate("document.getElementById('bar').hidden"))
                self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), size[0])
                self.keep_screenshot("viewer_" + name)
                self.check_quiet()

    def state(self):
        return json.loads(self.browser.evaluate(
            "JSON.stringify([viewer.camera.position, viewer.camera.distance, viewer.camera.axes])"))

    def test_the_mouse_and_keys_move_the_camera(self):
        self.open("run/viewer.html", SMALL)
        self.browser.wait(COMPLETE)
        position, distance, axes = self.state()
        self.browser.drag((150, 120), (120, 105))
        orbited = self.state()
        self.assertNotAlmostEqual(position[0], orbited[0][0], 3)
        self.assertAlmostEqual(distance, orbited[1])
        self.browser.call("Input.dispatchMouseEvent", type="mouseWheel", x=150, y=120, deltaX=0, deltaY=-200)
        self.browser.wait(f"viewer.camera.distance < {distance}")
        zoomed = self.state()
        self.browser.call("Input.dispatchKeyEvent", type="keyDown", code="KeyW", key="w")
        self.browser.wait(f"viewer.camera.position.some((x, k) => Math.abs(x - {json.dumps(zoomed[0])}[k]) > 1e-3)")
        self.browser.call("Input.dispatchKeyEvent", type="keyUp", code="KeyW", key="w")
        self.browser.evaluate("document.getElementById('reset').click()")
        self.assertEqual(self.state(), [position, distance, axes])
        for clicks in (1, 2):
            self.browser.mouse("mousePressed", 160, 120, buttons=1, clickCount=clicks)
            self.browser.mouse("mouseReleased", 160, 120, clickCount=clicks)
        self.assertNotEqual(self.state()[1], distance)
        self.browser.wait(COMPLETE)
        self.keep_screenshot("viewer_pivot")
        self.check_quiet()

    def test_fingers_turn_and_zoom(self):
        self.open("run/viewer.html", SMALL_TOUCH)
        self.browser.wait(COMPLETE)
        position, distance, _ = self.state()
        self.browser.drag((120, 150), (160, 150), touches=True)
        self.browser.wait(f"viewer.camera.position[0] !== {position[0]}")
        self.assertAlmostEqual(self.state()[1], distance)
        self.browser.touch("touchStart", (90, 150), (150, 150))
        self.browser.touch("touchMove", (60, 150), (180, 150))
        self.browser.touch("touchEnd")
        self.browser.wait(f"viewer.camera.distance < {0.7 * distance}")
        self.check_quiet()

    def test_without_webgl_the_viewer_shows_a_sentence(self):
        self.browser.call("Page.addScriptToEvaluateOnNewDocument",
                          source="HTMLCanvasElement.prototype.getContext = () => null")
        self.open("run/viewer.html", SIZES["desktop"])
        self.assertIn("no WebGL 2", self.browser.evaluate("document.getElementById('message').textContent"))
        self.check_quiet()

    def test_reports_fit_each_size_of_screen(self):
        for page in ("run/report.html", "held_out/report.html", "compare.html", "inspect.html"):
            for name, size in SIZES.items():
                with self.subTest(page + " " + name):
                    self.open(page, size)
                    self.assertLessEqual(self.browser.evaluate("document.documentElement.scrollWidth"), size[0])
                    self.assertTrue(self.browser.evaluate(
                        "[...document.images].filter(i => !i.closest('[hidden]')).every(i => i.naturalWidth > 0)"))
                    self.keep_screenshot(page.replace("/", "_").replace(".html", "_") + name)
                    self.check_quiet()

    def test_marks_lie_over_their_photo(self):
        # The sky of the scene fills the corners of its photos.
        for name, size in SIZES.items():
            with self.subTest(name):
                self.open("inspect.html", size)
                self.assertEqual(self.browser.evaluate(
                    "[...document.querySelectorAll('.marked')].filter(m => m.querySelector('svg')).map(m => {"
                    " const photo = m.querySelector('img').getBoundingClientRect();"
                    " return [...m.querySelectorAll('rect, circle')].every(shape => {"
                    "  const r = shape.getBoundingClientRect(), x = (r.left + r.right) / 2, y = (r.top + r.bottom) / 2;"
                    "  return x >= photo.left && x <= photo.right && y >= photo.top && y <= photo.bottom }) })"
                    ".filter(inside => !inside).length"), 0)
                self.assertTrue(self.browser.evaluate(
                    "(() => { const m = [...document.querySelectorAll('#sky .marked')][0],"
                    " photo = m.querySelector('img').getBoundingClientRect();"
                    " return [...m.querySelectorAll('rect.mark0')].some(shape => {"
                    "  const r = shape.getBoundingClientRect();"
                    "  return Math.abs(r.left - photo.left) < 1 && Math.abs(r.top - photo.top) < 1 }) })()"))
                self.check_quiet()

    def test_the_slider_moves_the_line_between_the_images(self):
        self.open("held_out/report.html", SIZES["desktop"])
        split = self.browser.evaluate(
            "(() => { const slider = document.querySelector('.pair input'); slider.value = 20;"
            " slider.dispatchEvent(new Event('input'));"
            " return getComputedStyle(document.querySelector('.over')).clipPath })()")
        self.assertIn("20%", split)

    def test_reports_have_a_dark_mode(self):
        self.browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
        self.open("run/report.html", SIZES["phone"])
        color = self.browser.evaluate("getComputedStyle(document.body).backgroundColor")
        self.assertLess(max(map(int, re.findall(r"\d+", color))), 60)
        self.keep_screenshot("report_dark")


if __name__ == "__main__":
    require_browser()
    unittest.main()
