#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Opens the live view of the program $WARPAGG_PROGRAM in the browser $WARPAGG_CHROMIUM, without a window: the page of a
model and of a running training, on a desktop and on a phone. With $WARPAGG_SCREENSHOTS, keeps screenshots in that
folder."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from browser import Browser, require_browser  # noqa: E402

SIZES = {"desktop": (1100, 800, 1, False), "phone": (390, 844, 2, True)}
SCENE = ["-d", "synthetic:spheres", "-r", "64", "--device", "cpu", "--effects", "none"]
PICTURE = "document.getElementById('canvas').toDataURL()"
FRAMES = "Number(document.getElementById('canvas').dataset.frames ?? 0)"
STATE = "document.getElementById('state').dataset.state"
ITERATION = "document.getElementById('iteration').textContent"

# The largest difference between two pixels of the canvas: zero if nothing is drawn.
CONTRAST = """(() => {
    const canvas = document.getElementById('canvas'), copy = document.createElement('canvas');
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext('2d', {willReadFrequently: true});
    context.drawImage(canvas, 0, 0);
    const red = context.getImageData(0, 0, copy.width, copy.height).data.filter((_, i) => i % 4 === 0);
    return red.reduce((a, b) => Math.max(a, b)) - red.reduce((a, b) => Math.min(a, b));
})()"""


class LiveView(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        subprocess.run([os.environ["WARPAGG_PROGRAM"], "train", *SCENE, "-i", "300", "-q", "-o", cls.folder / "model"],
                       check=True)

    def start(self, *arguments):
        """Starts the program, and returns the URL that it prints."""
        self.process = subprocess.Popen([os.environ["WARPAGG_PROGRAM"], *arguments], stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.process.communicate)
        self.addCleanup(self.process.kill)
        for line in self.process.stdout:
            if found := re.search(r"http://127\.0\.0\.1:\d+/\?token=\w+", line):
                return found.group()
        self.fail("the program prints no URL")

    def open(self, url, size):
        self.browser = Browser(os.environ["WARPAGG_CHROMIUM"], seconds=240)
        self.addCleanup(self.browser.__exit__)
        self.browser.open(url, *size)

    def click(self, button):
        self.browser.evaluate(f"document.getElementById('{button}').click()")

    def select(self, overlay):
        self.browser.evaluate(f"(s => {{ s.value = '{overlay}'; s.onchange(); }})(document.getElementById('overlay'))")

    def check_drag(self, touches):
        """A picture appears, and a drag changes it."""
        self.browser.wait(f"{FRAMES} > 0")
        self.assertGreater(self.browser.evaluate(CONTRAST), 50)
        before, frames = self.browser.evaluate(PICTURE), self.browser.evaluate(FRAMES)
        self.browser.drag((150, 400), (250, 430), touches)
        self.browser.wait(f"{FRAMES} > {frames} && {PICTURE} !== {before!r}")
        self.assertGreater(self.browser.evaluate(CONTRAST), 50)

    def check_fits(self):
        for condition in ("document.documentElement.scrollWidth <= innerWidth",
                          "document.querySelector('footer').getBoundingClientRect().bottom <= innerHeight + 1",
                          "document.getElementById('canvas').clientHeight > innerHeight / 2"):
            self.assertTrue(self.browser.evaluate(condition), condition)

    def keep_screenshot(self, name):
        """Makes an image for people to look at, if they want one."""
        if folder := os.environ.get("WARPAGG_SCREENSHOTS"):
            self.browser.screenshot(pathlib.Path(folder) / f"live_{name}.png")

    def check_retry(self):
        """The page asks again for a frame that was not drawn in time."""
        frames = self.browser.evaluate(FRAMES)
        self.browser.evaluate("""
            (original => {
                window.fetch = (path, options) => {
                    if (!path.startsWith('/frame')) return original(path, options);
                    window.fetch = original;
                    return Promise.resolve(new Response(null, {status: 204}));
                };
            })(fetch)""")
        self.click("home")
        self.browser.wait(f"{FRAMES} > {frames}")

    def check_model(self, name, size):
        model = self.folder / "model/point_cloud/iteration_300/point_cloud.ply"
        self.open(self.start("view", model, "--device", "cpu"), size)
        self.check_drag(touches=size[3])
        self.check_fits()
        before = self.browser.evaluate(PICTURE)
        self.select("depth")
        self.browser.wait(f"{PICTURE} !== {before!r}")
        self.assertTrue(self.browser.evaluate("document.getElementById('pause').hidden"))
        self.keep_screenshot("model_" + name)
        self.check_retry()
        self.assertEqual(self.browser.problems, [])

    def check_training(self, name, size):
        output = self.folder / name
        self.open(self.start("train", *SCENE, "-i", "1000000", "-o", output, "--viewer"), size)
        self.browser.wait(f"{STATE} === 'training'")
        self.check_drag(touches=size[3])
        self.browser.wait("document.getElementById('loss').textContent !== ''")
        self.click("pause")
        self.browser.wait(f"{STATE} === 'paused'")
        frames = self.browser.evaluate(FRAMES)
        self.select("error")
        self.browser.wait(f"{FRAMES} > {frames} && document.getElementById('view').value === '0'")
        self.check_fits()
        self.keep_screenshot("training_" + name)
        self.click("save")  # the training does it after the iteration that runs
        self.browser.wait("document.getElementById('message').textContent.startsWith('saved ')")
        iteration = self.browser.evaluate(ITERATION)
        time.sleep(1)
        self.assertEqual(self.browser.evaluate(ITERATION), iteration)
        self.assertTrue(list(output.glob("point_cloud/*/point_cloud.ply")))
        self.click("pause")
        self.browser.wait(f"{ITERATION} !== {iteration!r}")
        self.assertEqual(self.browser.problems, [])
        self.browser.evaluate("setTimeout(() => document.getElementById('stop').click())")
        self.browser.accept_dialog()
        self.assertEqual(self.process.wait(60), 130)
        self.browser.wait(f"{STATE} === 'ended'")

    def test_a_model_on_a_desktop(self):
        self.check_model("desktop", SIZES["desktop"])

    def test_a_model_on_a_phone(self):
        self.check_model("phone", SIZES["phone"])

    def test_a_training_on_a_desktop(self):
        self.check_training("desktop", SIZES["desktop"])

    def test_a_training_on_a_phone(self):
        self.check_training("phone", SIZES["phone"])


if __name__ == "__main__":
    require_browser()
    unittest.main()
