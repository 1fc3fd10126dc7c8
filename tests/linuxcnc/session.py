# SPDX-License-Identifier: Apache-2.0
"""A session of LinuxCNC (sim/linuxcnc/session) and what it leaves."""
import json
import os
import subprocess

import servo_log
from claims import claim


class Session:
    def __init__(self, source, work, program):
        self.source, self.work, self.program = source, work, program
        self.folder = os.path.dirname(os.path.abspath(__file__))

    def start(self, case, ngc, *words):
        environment = dict(os.environ, MILLFORCE_PROGRAM=self.program, MILLFORCE_CASE=case)
        out = os.path.join(self.work, case)
        return subprocess.Popen([os.path.join(self.source, "sim/linuxcnc/session"), "--out", out, *words, ngc],
                                env=environment)

    def run(self, case, ngc, *words, expected=0):
        out = os.path.join(self.work, case)
        code = self.start(case, ngc, *words).wait(800)
        if code != expected:
            with open(os.path.join(out, "linuxcnc.log"), encoding="utf-8") as log:
                print("".join(log.readlines()[-25:]))
        claim(code == expected, f"the session ends with exit code {expected} ({code})")
        return out

    def hazard(self, case, *words, expected=0):
        here = self.folder
        out = self.run(case, os.path.join(here, "straight.ngc"), "--display", "./hazard.py", "--home", "0 0 0", "--add",
                       os.path.join(here, "hazard.py"), *words, expected=expected)
        return servo_log.read(os.path.join(out, "motion.txt"))


def figures_of(folder, run=0):
    with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    return summary, summary["runs"][run]
