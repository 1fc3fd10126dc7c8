# SPDX-License-Identifier: Apache-2.0
"""A screen that nobody sees (Xvfb)."""
import os
import shutil
import subprocess
import sys

SKIPPED = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def start_screen():
    """DISPLAY names it from then on. Skips the test where there is no Xvfb."""
    if shutil.which("Xvfb") is None:
        skip("no Xvfb: the package xvfb is not installed")
    reading, writing = os.pipe()
    screen = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-nolisten", "tcp"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL)
    os.close(writing)
    with os.fdopen(reading, encoding="ascii") as numbers:
        number = numbers.readline().strip()
    if not number:
        skip("Xvfb does not start")
    os.environ["DISPLAY"] = ":" + number
    return screen
