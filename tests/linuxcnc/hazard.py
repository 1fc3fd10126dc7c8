#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC's DISPLAY program of a hazard: starts a straight cut, does in the middle of it what MILLFORCE_CASE says, and
waits for what comes of it. What happened in the servo thread is judged afterwards, from motion.txt."""
import os
import select
import signal
import subprocess
import sys
import time

import linuxcnc

from drive import Drive, pin

PREAMBLE = {"m52_missing": "M52 P0", "m51_p0": "M52 P1\nM51 P0", "m52_and_m51_missing": "M52 P0\nM51 P0"}
INJECTED = {"nan": "nan", "infinite": "inf", "negative": "-0.5", "zero": "0", "above_one": "5", "thread": "0.07"}
# What hangs, so that the readings of the spindle's current stand still.
HANGS = {"hy_vfd_hangs": "millforce-slow-drive.0.hangs", "mb2hal_hangs": "modbus-slave.hangs"}
# A spindle with the position that G33 wants.
THREADING = """loadrt sim_spindle names=thread-spindle
addf thread-spindle servo-thread
net spindle-rps => thread-spindle.velocity-cmd
net thread-revs thread-spindle.position-fb => spindle.0.revs
net thread-index thread-spindle.index-enable <=> spindle.0.index-enable
"""
# The program goes on to its end; elsewhere it is aborted.
ENDS = ("zero", "above_one", "reset", "fall_back", "response", "controller_restarted", "controller_late")


def halcmd(*words):
    subprocess.run(["halcmd", *words], check=True)


def cycles():
    """Servo cycles since the start: the only time that counts, however slow the computer is."""
    return int(pin("millforce-plant.cycle"), 0)


def wait_cycles(number):
    end = cycles() + number
    while cycles() < end:
        time.sleep(0.02)


def break_off(drive):
    """Ends the program, with what follows in the log."""
    drive.command.abort()
    drive.command.wait_complete(5)
    wait_cycles(200)


def client():
    return int(subprocess.run(["pidof", "millforce-hal"], capture_output=True, text=True, check=True).stdout)


def controller():
    with open("controller.pid", encoding="ascii") as file:
        return int(file.read())


def inject(value):
    halcmd("unlinkp", "millforce.override")
    halcmd("sets", "millforce-override", value)


def go_on(pid):
    os.kill(pid, signal.SIGCONT)
    set_patience(60)


def press_reset():
    for level in ("1", "0"):
        halcmd("sets", "millforce-reset", level)
        wait_cycles(50)


def set_patience(seconds):
    """Where the controller is about to be hung the simulated machine must not wait for it."""
    halcmd("setp", "millforce-plant.patience", str(seconds))


def kill_controller():
    """Until it is dead: as long as it holds the socket, the next one is refused."""
    pid = controller()
    death = os.pidfd_open(pid)
    os.kill(pid, signal.SIGKILL)
    select.select([death], [], [])


def start_controller():
    """As somebody would by hand: the socket of the dead one is still there."""
    names = os.environ
    with open("controller.log", "a", encoding="utf-8") as log:
        process = subprocess.Popen([names["millforce"], "serve", "controller.sock", "--machine", names["machine"],
                                    "--tool", names["tool"]], stdout=log, stderr=log)
    with open("controller.pid", "w", encoding="ascii") as file:
        file.write(str(process.pid))


def is_connected():
    return pin("millforce.connected") == "TRUE"


def wait_connected(drive):
    drive.until("connected", is_connected, 120.0)
    wait_cycles(200)


def act(case):
    """Returns what is to be done before the end."""
    if case in ("client_killed", "m51_p0", "fall_back", "client_hung", "controller_hung", "reset"):
        set_patience(0.2)
    if case in INJECTED:
        inject(INJECTED[case])
    elif case in HANGS:
        halcmd("setp", HANGS[case], "1")
    elif case in ("client_killed", "m51_p0"):
        os.kill(client(), signal.SIGKILL)
    elif case == "fall_back":
        halcmd("setp", "millforce-guard.0.stop-on-fault", "0")
        os.kill(client(), signal.SIGKILL)
    elif case == "controller_killed":
        kill_controller()
    elif case == "heartbeat_back":
        subprocess.run(["halcmd", "-f"], input="unlinkp millforce.heartbeat\nsets millforce-heartbeat 1\n", text=True, check=True)
    elif case == "controller_restarted":
        kill_controller()
        start_controller()
    elif case == "client_hung":
        pid = client()
        os.kill(pid, signal.SIGSTOP)
        return lambda: os.kill(pid, signal.SIGKILL)
    elif case in ("controller_hung", "reset"):
        pid = controller()
        os.kill(pid, signal.SIGSTOP)
        return lambda: go_on(pid)
    elif case == "response":
        halcmd("setp", "millforce-guard.0.max-rise", "1000")
        for value in ("0.2", "0.8", "0.3", "0.6"):
            inject(value) if value == "0.2" else halcmd("sets", "millforce-override", value)
            wait_cycles(250)
    return lambda: None


def main():
    case = os.environ["MILLFORCE_CASE"]
    drive = Drive()
    drive.make_ready()
    with open("straight.ngc", encoding="ascii") as file:
        text = file.read().replace("M52 P1", PREAMBLE.get(case, "M52 P1"))
    if case == "thread":
        subprocess.run(["halcmd", "-f"], input=THREADING, text=True, check=True)
        text = text.replace("G1 X44", "G33 X44 K0.06")
    with open("case.ngc", "w", encoding="ascii") as file:
        file.write(text)
    if case == "controller_late":
        kill_controller()
        drive.until("no controller", lambda: not is_connected(), 120.0)
        wait_cycles(200)
    drive.start("case.ngc")
    if case == "controller_late":
        wait_cycles(1000)
        press_reset()
        start_controller()
        wait_connected(drive)
        press_reset()
        drive.await_end(300.0)
        return 1 if drive.errors else 0
    begun_mm = 0.2 if case in PREAMBLE and case != "m51_p0" else 6.0
    drive.until("cutting", lambda: drive.stat.actual_position[0] > begun_mm, 120.0)
    before_the_end = act(case)
    drive.say(case)
    wait_cycles(1500)
    if case == "zero":
        halcmd("sets", "millforce-override", "0.4")
    before_the_end()
    if case == "controller_restarted":
        wait_connected(drive)
        press_reset()
    if case == "reset":
        wait_cycles(300)
        press_reset()
    if case in ENDS:
        drive.await_end(300.0)
        return 1 if drive.errors else 0
    drive.poll()
    break_off(drive)
    return 0


if __name__ == "__main__":
    sys.exit(main())
