#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC's DISPLAY program of the qtvcp panel's case: mills a slot with the panel on the screen, changes to a tool that the
controller does not know, hangs the controller for a while, and clicks on the panel's Reset."""
import json
import os
import signal
import subprocess
import sys

from Xlib import X, display
from Xlib.ext import xtest

import linuxcnc

from drive import Drive
from hazard import break_off, controller, go_on, halcmd, set_patience, wait_cycles


def seen():
    """The panel's newest whole line."""
    try:
        with open("panel.jsonl", encoding="utf-8") as file:
            lines = file.read().split("\n")
    except FileNotFoundError:
        return {}
    return json.loads(lines[-2]) if len(lines) > 1 else {}


def signal_is(name, value):
    shown = subprocess.run(["halcmd", "gets", name], capture_output=True, text=True, check=True).stdout.strip()
    return shown == value


class Mouse:
    def __init__(self):
        self.display = display.Display()

    def button(self, kind):
        xtest.fake_input(self.display, kind, 1)
        self.display.sync()

    def move(self, x, y):
        xtest.fake_input(self.display, X.MotionNotify, x=x, y=y)
        self.display.sync()


def click_reset(drive):
    mouse = Mouse()
    mouse.move(*seen()["button"])
    mouse.button(X.ButtonPress)
    drive.until("Reset pressed", lambda: signal_is("millforce-reset", "TRUE"))
    wait_cycles(100)
    mouse.button(X.ButtonRelease)
    drive.until("Reset released", lambda: signal_is("millforce-reset", "FALSE"))


def hang_controller(drive):
    set_patience(0.2)
    pid = controller()
    os.kill(pid, signal.SIGSTOP)
    try:
        drive.until("the panel shows the guard's fault", lambda: seen().get("reason") == "HEARTBEAT")
    finally:
        go_on(pid)
    wait_cycles(500)


def main():
    os.environ["DISPLAY"] = os.environ["MILLFORCE_SCREEN"]
    subprocess.run(["halcmd", "loadusr", "-Wn", "qtvcp", "qtvcp", "-c", "qtvcp", "-g", "340x470+0+0", "-u",
                    "panel_probe_handler.py", "millforce_panel"], check=True, timeout=120)
    halcmd("-i", os.environ["INI_FILE_NAME"], "-f", "millforce_panel_qtvcp.hal")
    drive = Drive()
    drive.make_ready()
    drive.start(linuxcnc.ini(os.environ["INI_FILE_NAME"]).find("DISPLAY", "OPEN_FILE"))
    drive.until("the panel says that T2 is not known", lambda: seen().get("tool") == "2" and "tool_unknown" in seen(), 300.0)
    wait_cycles(500)
    hang_controller(drive)
    if seen().get("reason") != "HEARTBEAT":
        drive.fail("the fault stays until the reset")
    click_reset(drive)
    drive.until("the panel shows no fault any more", lambda: seen().get("reason") == "none")
    break_off(drive)
    return 0


if __name__ == "__main__":
    sys.exit(main())
