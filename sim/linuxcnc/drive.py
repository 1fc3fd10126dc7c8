#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Runs OPEN_FILE of the INI file headless: LinuxCNC's DISPLAY program where there is no screen. Its exit code becomes
that of `linuxcnc`: 0, the program came to its end; 1, LinuxCNC reported an error; 2, something did not happen in time, or force
control has a fault, which nobody resets here."""
import os
import subprocess
import sys
import time

import linuxcnc

# What holds the feed for good: its pin, and where its numbers are explained.
FAULTS = (("millforce-guard.0.reason", "drivers/linuxcnc/millforce_guard.comp"), ("millforce.fault", "control/README.md"))


def pin(name):
    answer = subprocess.run(["halcmd", "getp", name], capture_output=True, text=True)
    if answer.returncode != 0:
        print(f"FAILED: halcmd getp {name}: {answer.stderr.strip() or answer.stdout.strip()}", flush=True)
        sys.exit(2)
    return answer.stdout.strip()


def fault_that_holds():
    for name, page in FAULTS:
        number = pin(name)
        if number != "0":
            return f"the feed is held: {name} is {number}, see {page}"
    return None


class Drive:
    def __init__(self):
        self.start_s = time.monotonic()
        self.command = linuxcnc.command()
        self.stat = linuxcnc.stat()
        self.error_channel = linuxcnc.error_channel()
        self.errors = []
        for _ in range(400):  # milltask starts in the background
            try:
                self.stat.poll()
                return
            except linuxcnc.error:
                time.sleep(0.05)
        self.fail("milltask does not answer")

    def say(self, text):
        print(f"[{time.monotonic() - self.start_s:7.3f}] {text}", flush=True)

    def fail(self, text):
        self.say("FAILED: " + text)
        sys.exit(2)

    def poll(self):
        self.stat.poll()
        message = self.error_channel.poll()
        if message and message[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR):
            self.say("error: " + message[1])
            self.errors.append(message[1])

    def until(self, what, is_so, timeout_s=120.0, errors_end_it=True):  # beside busy programs homing takes a minute
        end_s = time.monotonic() + timeout_s
        while not is_so():
            if (self.errors and errors_end_it) or time.monotonic() > end_s:
                self.fail(what)
            time.sleep(0.01)
            self.poll()
        self.say(what)

    def step(self, what, is_so, send):
        send()
        self.command.wait_complete(15)
        self.until(what, is_so)

    def make_ready(self):
        c, s = self.command, self.stat
        self.step("estop reset", lambda: s.task_state == linuxcnc.STATE_ESTOP_RESET,
                  lambda: c.state(linuxcnc.STATE_ESTOP_RESET))
        self.step("machine on", lambda: s.task_state == linuxcnc.STATE_ON, lambda: c.state(linuxcnc.STATE_ON))
        self.step("manual", lambda: s.task_mode == linuxcnc.MODE_MANUAL, lambda: c.mode(linuxcnc.MODE_MANUAL))
        self.step("homed", lambda: all(s.homed[:3]), lambda: c.home(-1))
        self.step("auto", lambda: s.task_mode == linuxcnc.MODE_AUTO, lambda: c.mode(linuxcnc.MODE_AUTO))

    def start(self, program):
        self.command.program_open(os.path.abspath(program))
        self.command.wait_complete(15)
        self.command.auto(linuxcnc.AUTO_RUN, 0)
        self.until("running", lambda: self.stat.interp_state != linuxcnc.INTERP_IDLE)

    def is_done(self):
        return self.stat.interp_state == linuxcnc.INTERP_IDLE and self.stat.inpos and self.stat.queue == 0

    def await_end(self, timeout_s=3600.0, ends_at_fault=False):
        next_look_s = time.monotonic()

        def is_done():
            nonlocal next_look_s
            if ends_at_fault and time.monotonic() > next_look_s:
                next_look_s = time.monotonic() + 2.0
                fault = fault_that_holds()
                if fault:
                    self.fail(fault)
            return self.is_done()

        self.until("program ended", is_done, timeout_s)
        # The recording is read out of its buffer, and the spindle's stop ends the plant's run.
        time.sleep(0.3)


def main():
    ini = linuxcnc.ini(os.environ["INI_FILE_NAME"])
    drive = Drive()
    drive.make_ready()
    drive.start(ini.find("DISPLAY", "OPEN_FILE"))
    drive.await_end(ends_at_fault=True)
    return 1 if drive.errors else 0


if __name__ == "__main__":
    sys.exit(main())
