#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Opens the live view in Chromium: the page of a model and of a running training, on a desktop and a phone.

    test_in_browser.py PROGRAM [FOLDER]   # keeps screenshots in FOLDER
"""
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from browser import Browser, free_port, require_browser  # noqa: E402

DESKTOP, PHONE = (1100, 800, False), (390, 844, True)
PICTURE = "document.getElementById('canvas').toDataURL()"
FRAMES = "Number(document.getElementById('canvas').dataset.frames ?? 0)"
STATE = "document.getElementById('state').dataset.state"

# The largest difference between two pixels of the canvas: zero if nothing is drawn.
CONTRAST = """
    const canvas = document.getElementById('canvas');
    const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    let least = 255, most = 0;
    for (let i = 0; i < pixels.length; i += 4) {
        least = Math.min(least, pixels[i]);
        most = Math.max(most, pixels[i]);
    }
    return most - least;"""


class Program:
    """A run of the program with a page."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([*arguments], stdout=subprocess.PIPE, text=True)
        for line in self.process.stdout:
            if found := re.search(r"http://127\.0\.0\.1:\d+/\?token=\w+", line):
                self.url = found.group()
                return
        raise AssertionError("the program prints no URL")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


def check_picture(browser):
    """A picture appears, and a drag changes it."""
    browser.wait_for(f"{FRAMES} > 0")
    assert browser.run(CONTRAST) > 50, "the picture is empty"
    browser.wait_for("document.readyState === 'complete'")
    before, frames = browser.run(f"return {PICTURE}"), browser.run(f"return {FRAMES}")
    return before, frames


def check_drag(browser, touches):
    before, frames = check_picture(browser)
    browser.drag((150, 400), (250, 430), touches)
    browser.wait_for(f"{FRAMES} > {frames} && {PICTURE} !== {before!r}")
    assert browser.run(CONTRAST) > 50, "the picture is empty after a drag"


def check_fits(browser):
    assert browser.run("return document.documentElement.scrollWidth <= innerWidth"), "the page is too wide"
    assert browser.run("return document.querySelector('footer').getBoundingClientRect().bottom <= innerHeight + 1")
    assert browser.run("return document.getElementById('canvas').clientHeight > innerHeight / 2")


def check_model(program, model, size, folder):
    width, height, phone = size
    with Program(program, "view", model, "--device", "cpu", "--port", str(free_port())) as run, \
            Browser(width, height, phone) as browser:
        start = time.monotonic()
        browser.open(run.url)
        check_drag(browser, phone)
        check_fits(browser)
        before = browser.run(f"return {PICTURE}")
        browser.run("const s = document.getElementById('overlay'); s.value = 'depth'; s.onchange();")
        browser.wait_for(f"{PICTURE} !== {before!r}")
        assert browser.run("return document.getElementById('pause').hidden")
        browser.screenshot(folder / f"model_{width}.png")
        assert browser.errors() == []
        print(f"a model at {width} x {height}: {time.monotonic() - start:.1f} s")


def check_training(program, folder, size):
    width, height, phone = size
    output = folder / f"run_{width}"
    with Program(program, "train", "-d", "synthetic:spheres", "-r", "64", "-i", "1000000", "--device", "cpu",
                 "--effects", "none", "-o", output, "--viewer", str(free_port())) as run, \
            Browser(width, height, phone) as browser:
        browser.open(run.url)
        browser.wait_for(f"{STATE} === 'training'")
        check_drag(browser, phone)
        browser.wait_for("document.getElementById('loss').textContent !== ''")
        browser.run("document.getElementById('pause').click()")
        browser.wait_for(f"{STATE} === 'paused'")
        frames = browser.run(f"return {FRAMES}")
        browser.run("const s = document.getElementById('overlay'); s.value = 'error'; s.onchange();")
        browser.wait_for(f"{FRAMES} > {frames} && document.getElementById('view').value === '0'")
        check_fits(browser)
        time.sleep(1)
        iteration = browser.run("return document.getElementById('iteration').textContent")
        time.sleep(1)
        assert iteration == browser.run("return document.getElementById('iteration').textContent"), "no pause"
        browser.screenshot(folder / f"training_{width}.png")
        browser.run("document.getElementById('save').click()")
        browser.wait_for("document.getElementById('message').textContent.startsWith('saved ')")
        assert list(output.glob("point_cloud/*/point_cloud.ply")), "nothing is saved"
        browser.run("document.getElementById('pause').click()")
        browser.wait_for(f"document.getElementById('iteration').textContent !== {iteration!r}")
        assert browser.errors() == []
        browser.run("setTimeout(() => document.getElementById('stop').click())")
        time.sleep(0.5)
        browser.accept_dialog()
        assert run.process.wait(60) == 130
        browser.wait_for(f"{STATE} === 'ended'")
        print(f"a training at {width} x {height}")


def main():
    require_browser()
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        folder.mkdir(exist_ok=True)
        subprocess.run([program, "train", "-d", "synthetic:spheres", "-r", "64", "-i", "300", "--device", "cpu",
                        "--effects", "none", "--overwrite", "-q", "-o", folder / "model"], check=True)
        model = folder / "model/point_cloud/iteration_300/point_cloud.ply"
        for size in (DESKTOP, PHONE):
            check_model(program, model, size, folder)
            check_training(program, folder, size)


if __name__ == "__main__":
    main()
