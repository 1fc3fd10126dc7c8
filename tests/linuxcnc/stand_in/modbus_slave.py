#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A VFD at the other end of a serial line, ./vfd: answers Modbus RTU, function 3 (read holding registers), with the
simulated spindle's current in 0.1 A, its frequency in 0.1 Hz and the voltage of its DC link in 0.1 V, from 0x2103 on."""
import os
import struct
import tty

import hal

FIRST = 0x2103
REQUEST_BYTES = 8


def checksum(frame):
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0xA001 if crc & 1 else 0)
    return struct.pack("<H", crc)


def answer(request, registers):
    """None: not a request to this slave."""
    address, function, first, number = struct.unpack(">BBHH", request[:6])
    if checksum(request[:6]) != request[6:] or function != 3:
        return None
    words = [registers[first - FIRST + k] for k in range(number)]
    frame = struct.pack(f">BBB{number}H", address, function, 2 * number, *words)
    return frame + checksum(frame)


def tenths(value):
    return max(0, min(0xFFFF, round(10.0 * value)))


def main():
    component = hal.component("modbus-slave")
    for name in ("current", "speed", "dc-bus"):
        component.newpin(name, hal.HAL_FLOAT, hal.HAL_IN)
    component.newpin("hangs", hal.HAL_BIT, hal.HAL_IN)
    master, slave = os.openpty()
    tty.setraw(slave)
    if os.path.islink("vfd"):
        os.unlink("vfd")
    os.symlink(os.ttyname(slave), "vfd")
    component.ready()
    request = b""
    while True:
        request += os.read(master, REQUEST_BYTES - len(request))
        if len(request) < REQUEST_BYTES:
            continue
        words = [tenths(component["current"]), tenths(2.0 * component["speed"]), tenths(component["dc-bus"])]
        frame = answer(request, words)
        request = b""
        if frame is not None and not component["hangs"]:
            os.write(master, frame)


if __name__ == "__main__":
    main()
