# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Drives Debian's Chromium through chromedriver, with Python's standard library only."""
import base64
import json
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

SKIPPED = 77  # the exit status that CTest counts as skipped

FLAGS = ("--headless=new --no-sandbox --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync --use-angle=swiftshader --enable-unsafe-swiftshader").split()


def require_browser():
    """Ends the test as skipped if there is no browser."""
    for program in ("chromium", "chromedriver"):
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed (Debian's packages chromium and chromium-driver)")
            sys.exit(SKIPPED)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Browser:
    """A window of a size. `phone`: with a touch screen and a mobile user agent."""

    def __init__(self, width, height, phone=False):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        port = free_port()
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        self.url = f"http://127.0.0.1:{port}"
        options = {"binary": shutil.which("chromium"),
                   "args": [*FLAGS, f"--user-data-dir={self.profile.name}", f"--window-size={width},{height}"]}
        if phone:
            options["mobileEmulation"] = {"deviceMetrics": {"width": width, "height": height, "pixelRatio": 2,
                                                            "touch": True}}
        self._await_driver()
        created = self._call("POST", "/session", {"capabilities": {"alwaysMatch": {
            "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"},
            "unhandledPromptBehavior": "ignore"}}})
        self.url += "/session/" + created["sessionId"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self._call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.profile.cleanup()

    def _await_driver(self):
        for _ in range(600):
            try:
                if self._call("GET", "/status")["ready"]:
                    return
            except OSError:
                time.sleep(0.05)
        raise RuntimeError("chromedriver does not start")

    def _call(self, method, path, body=None):
        data = None if method != "POST" else json.dumps(body or {}).encode()
        request = urllib.request.Request(self.url + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as failed:
            raise RuntimeError(json.load(failed)["value"]["message"]) from None

    def open(self, url):
        self._call("POST", "/url", {"url": url})

    def run(self, script):
        """The value of a script, such as `return document.title`."""
        return self._call("POST", "/execute/sync", {"script": script, "args": []})

    def wait_for(self, condition, seconds=60):
        """Waits until an expression of JavaScript is true."""
        until = time.monotonic() + seconds
        while not self.run(f"return Boolean({condition})"):
            if time.monotonic() > until:
                raise AssertionError(f"not true after {seconds} s: {condition}")
            time.sleep(0.05)

    def drag(self, start, end, touches=False):
        """Drags from a point of the page to another, in pixels."""
        def move(to, milliseconds):
            return {"type": "pointerMove", "duration": milliseconds, "x": to[0], "y": to[1], "origin": "viewport"}
        pointer = {"type": "pointer", "id": "pointer", "parameters": {"pointerType": "touch" if touches else "mouse"},
                   "actions": [move(start, 0), {"type": "pointerDown", "button": 0}, move(end, 300),
                               {"type": "pointerUp", "button": 0}]}
        self._call("POST", "/actions", {"actions": [pointer]})

    def accept_dialog(self):
        self._call("POST", "/alert/accept")

    def errors(self):
        """The errors on the console since the last call."""
        return [entry["message"] for entry in self._call("POST", "/se/log", {"type": "browser"})
                if entry["level"] == "SEVERE"]

    def screenshot(self, file):
        with open(file, "wb") as out:
            out.write(base64.b64decode(self._call("GET", "/screenshot")))
