# SPDX-License-Identifier: Apache-2.0
"""A CNC's bridge for `millforce serve`: plays a recording of `millforce simulate --record` in real time.
Layout of the messages: drivers/local_link/include/local_link/messages.hpp."""
import csv
import math
import socket
import struct
import threading
import time

SAMPLE = struct.Struct("<4sHHIIIIBBBBf3f3fffIfIf")
AXES = ("x", "y", "z")


class Cnc(threading.Thread):
    """After the recording's end its last moment stays, with the spindle turning, until stop()."""

    def __init__(self, socket_path, recording, counts_per_rev):
        super().__init__(daemon=True)
        with open(recording, newline="", encoding="ascii") as file:
            self.rows = list(csv.DictReader(file))
        self.counts_per_rad = counts_per_rev / (2 * math.pi)
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.connect(socket_path)
        self.stopped = threading.Event()

    def run(self):
        time_s, angle_rad = self.place_of(self.rows[0])
        begin_s = time.monotonic() - time_s
        last_s, last_rad = time_s, angle_rad
        sequence = 0
        while not self.stopped.is_set():
            row = self.rows[min(sequence, len(self.rows) - 1)]
            if sequence < len(self.rows):
                time_s, angle_rad = self.place_of(row)
                step_s, step_rad = time_s - last_s, angle_rad - last_rad or 0.1
            else:
                time_s, angle_rad = last_s + step_s, last_rad + step_rad
            last_s, last_rad = time_s, angle_rad
            sequence += 1
            time.sleep(max(0.0, time_s - (time.monotonic() - begin_s)))
            self.socket.send(self.sample(sequence, time_s, angle_rad, row))
            self.socket.recv(1024)
        self.socket.close()

    @staticmethod
    def place_of(row):
        return float(row["time_s"]), float(row["spindle_angle_rad"])

    def sample(self, sequence, time_s, angle_rad, row):
        return SAMPLE.pack(
            b"MFLK", 4, 1, sequence, round((time_s + 10) * 1e6) % 2**32, round(angle_rad * self.counts_per_rad) % 2**32,
            0, 0, 0x1F, int(row["rapid"]), 0, float(row["spindle_current_A"]),
            *(float(row[f"{axis}_current_A"]) for axis in AXES),
            *(float(row[f"{axis}_velocity_mm_s"]) for axis in AXES),
            float(row["programmed_feed_mm_s"]), 1.0, 0, 0.0, 0, float(row["commanded_speed_rad_s"]))

    def stop(self):
        self.stopped.set()
        self.join()
