# SPDX-License-Identifier: Apache-2.0
"""A page in Chromium, by the DevTools protocol."""
import base64
import contextlib
import json
import re
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SCREENS = ((1280, 900), (390, 844))
PATIENCE_S = 60


def browser():
    """None where it, or what drives it, is missing."""
    try:
        import websocket  # noqa: F401
    except ImportError:
        return None
    return next(filter(None, map(shutil.which, BROWSERS)), None)


def line_with(stream, pattern):
    """The match in the next line of the stream that has one."""
    for line in stream:
        if found := re.search(pattern, line):
            return found
    sys.exit(f"the output ended without {pattern}")


class Page:
    """A page of a browser, by the DevTools protocol."""

    def __init__(self, address):
        import websocket
        self.connection = websocket.create_connection(address, timeout=PATIENCE_S, suppress_origin=True)
        self.number = 0
        self.complaints = []
        for domain in ("Page", "Runtime", "Log"):
            self.call(domain + ".enable")

    def call(self, method, **parameters):
        self.number += 1
        self.connection.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.connection.recv())
            self.note(message)
            if message.get("id") == self.number:
                if "error" in message:
                    sys.exit(f"{method}: {message['error']}")
                return message["result"]

    def show(self, url, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.call("Page.navigate", url=url)

    def beyond_the_edge_px(self):
        return max(0, self.value_of("document.documentElement.scrollWidth - document.documentElement.clientWidth"))

    def save_picture(self, folder, name):
        if folder:
            picture = self.call("Page.captureScreenshot", captureBeyondViewport=True)["data"]
            (Path(folder) / f"{name}.png").write_bytes(base64.b64decode(picture))

    def note(self, message):
        entry = message.get("params", {}).get("entry", {})
        if message.get("method") == "Runtime.exceptionThrown" or entry.get("level") == "error":
            self.complaints.append(json.dumps(message["params"]))

    def value_of(self, expression):
        result = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        if "exceptionDetails" in result:
            sys.exit(f"{expression}: {result['exceptionDetails']}")
        return result["result"]["value"]

    def wait_until(self, expression):
        end = time.monotonic() + PATIENCE_S
        while not self.value_of(expression):
            if time.monotonic() > end:
                sys.exit(f"not within {PATIENCE_S} s: {expression}")
            time.sleep(0.1)


@contextlib.contextmanager
def opened_page(program, folder):
    words = [program, "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-dev-shm-usage",
             f"--user-data-dir={folder}/browser", "--remote-debugging-port=0", "about:blank"]
    with subprocess.Popen(words, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True) as process:
        try:
            port = line_with(process.stderr, r"DevTools listening on ws://127\.0\.0\.1:(\d+)/").group(1)
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
                address = next(page["webSocketDebuggerUrl"] for page in json.load(answer) if page["type"] == "page")
            yield Page(address)
        finally:
            process.send_signal(signal.SIGTERM)
