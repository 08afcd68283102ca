# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
"""Drives headless Chromium through pipes, with Python's standard library only."""
import base64
import json
import os
import select
import subprocess
import sys
import tempfile
import time
import urllib.parse

FLAGS = ("--headless=new", "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--remote-debugging-pipe", "--hide-scrollbars", "--force-color-profile=srgb")


SKIPPED = 77  # the exit status that CTest counts as skipped


def require_browser():
    """Returns the browser's program. Without one, ends the test as skipped."""
    program = os.environ.get("WARPAGG_CHROMIUM")
    if not program:
        print("skipped: Chromium is not installed (Debian's package chromium)")
        sys.exit(SKIPPED)
    return program


class BrowserError(Exception):
    """The browser refused a command, or did not answer in time."""


class Browser:
    """One page in a new browser. Use it in a `with` statement."""

    def __init__(self, program, seconds=60):
        self.deadline = time.monotonic() + seconds
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.output = os.pipe()
        self.input, from_browser = os.pipe()
        # Chromium reads commands from descriptor 3 and answers on descriptor 4.
        command = ["sh", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "sh", program, *FLAGS,
                   f"--user-data-dir={self.profile.name}", "about:blank"]
        self.process = subprocess.Popen(command, pass_fds=(to_browser, from_browser),
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self.received, self.last_id = b"", 0
        self.problems = []  # errors on the console, exceptions, and requests beyond the page
        self.has_dialog = False
        self.own = ()  # beginnings of the addresses that the page may load
        self.session = None
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        os.close(self.output)
        os.close(self.input)
        self.profile.cleanup()

    def call(self, method, **parameters):
        self.last_id += 1
        message = {"id": self.last_id, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.output, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") != self.last_id:
                self.note(answer)
            elif "error" in answer:
                raise BrowserError(f"{method}: {answer['error']['message']}")
            else:
                return answer["result"]

    def receive(self):
        while b"\0" not in self.received:
            left = self.deadline - time.monotonic()
            if left <= 0 or not select.select([self.input], [], [], left)[0]:
                raise BrowserError("the browser does not answer")
            part = os.read(self.input, 1 << 20)
            if not part:
                raise BrowserError("the browser has ended")
            self.received += part
        text, self.received = self.received.split(b"\0", 1)
        return json.loads(text)

    def note(self, event):
        parameters = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        if event.get("method") == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning"):
            self.problems.append(str([a.get("value", a.get("description")) for a in parameters["args"]]))
        if event.get("method") == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            # SwiftShader itself is slow at reading pixels, and says so.
            if "GPU stall due to ReadPixels" not in parameters["entry"]["text"]:
                self.problems.append(parameters["entry"]["text"])
        if event.get("method") == "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            if not url.startswith(("data:", "blob:", "about:", *self.own)):
                self.problems.append("the page asks for " + url)

        if event.get("method") == "Page.javascriptDialogOpening":
            self.has_dialog = True

    def open(self, address, width, height, ratio=1, mobile=False):
        """Shows a page, which may load only files or, if a server sent it, only from this server."""
        parts = urllib.parse.urlsplit(address)
        self.own = (f"{parts.scheme}://{parts.netloc}/",)
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio,
                  mobile=mobile)
        self.call("Emulation.setTouchEmulationEnabled", enabled=mobile)
        self.call("Page.navigate", url=address)
        self.wait("document.readyState === 'complete'")

    def evaluate(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise BrowserError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def wait(self, condition):
        while not self.evaluate(condition):
            if time.monotonic() > self.deadline:
                raise BrowserError("never true: " + condition)
            time.sleep(0.02)

    def mouse(self, kind, x, y, **more):
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", **more)

    def touch(self, kind, *points):
        self.call("Input.dispatchTouchEvent", type=kind,
                  touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])

    def drag(self, start, end, touches=False):
        """Drags from a point of the page to another, with the mouse or with a finger."""
        if touches:
            self.touch("touchStart", start)
            self.touch("touchMove", end)
            self.touch("touchEnd")
        else:
            self.mouse("mousePressed", *start, buttons=1, clickCount=1)
            self.mouse("mouseMoved", *end, buttons=1)
            self.mouse("mouseReleased", *end, clickCount=1)

    def accept_dialog(self):
        """Waits for a dialog of the page, and answers yes."""
        while not self.has_dialog:
            self.note(self.receive())
        self.has_dialog = False
        self.call("Page.handleJavaScriptDialog", accept=True)

    def screenshot(self, file, whole=False):
        image = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(file, "wb") as out:
            out.write(base64.b64decode(image["data"]))
