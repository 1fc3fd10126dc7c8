#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The operator of the page's air cut, as LinuxCNC's DISPLAY program: machine on, home, run. Leaves LinuxCNC when the page has
checked the pins."""
import os
import subprocess
import sys
import time

import linuxcnc

from drive import Drive, pin

HOME = os.environ["HOME"]


def main():
    # The servo thread waits for the controller's answers, however busy the computer is.
    subprocess.run(["halcmd", "-f", "plant_report.hal"], check=True)
    drive = Drive()
    drive.make_ready()
    drive.start(linuxcnc.ini(os.environ["INI_FILE_NAME"]).find("DISPLAY", "OPEN_FILE"))
    drive.until("feeds", lambda: drive.stat.motion_type == linuxcnc.MOTION_TYPE_FEED)
    with open(os.path.join(HOME, "air_cut_runs"), "w", encoding="ascii"):
        pass
    drive.await_end(300.0)
    fault = pin("millforce.fault")
    drive.say(f"with the spindle off: fault {fault}")
    while not os.path.exists(os.path.join(HOME, "checked")):
        time.sleep(0.1)
    return 1 if drive.errors or fault != "0" else 0


if __name__ == "__main__":
    sys.exit(main())
