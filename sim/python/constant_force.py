#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the mean tangential force of a cut: python3 constant_force.py SOCKET [NEWTONS]"""
import json, pathlib, socket, sys

path, target_N = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 250.0
pathlib.Path(path).unlink(missing_ok=True)
with socket.socket(socket.AF_UNIX) as listener:
    listener.bind(path)
    listener.listen()
    lines = listener.accept()[0].makefile("rw", buffering=1)

hello = json.loads(lines.readline())
machine, radius_m = hello["machine"], hello["tool"]["tool"]["diameter_mm"] / 2000
answer = {"type": "ready", "version": 1, "name": "constant force"}
idle_A, force_N, ratio = 0.0, 0.0, 1.0
while True:
    lines.write(json.dumps(answer) + "\n")
    sample = json.loads(lines.readline())
    if sample["type"] != "sample":
        sys.exit(sample.get("message"))  # none at the end of a run
    if sample["time_s"] < 0:  # the spindle turns, the program has not begun
        idle_A += 0.01 * (sample["spindle_current_A"] - idle_A)
    torque_Nm = machine["spindle"]["K_t1_Nm_per_A"] * (sample["spindle_current_A"] - idle_A)
    force_N += 0.02 * (torque_Nm / radius_m - force_N)  # 50 samples of smoothing
    ratio += 0.002 * (1 - force_N / target_N)  # at twice the target it falls by 1 in 0.5 s
    ratio = min(max(ratio, machine["cnc"]["override_min"]), 1.0)
    answer = {"override": ratio}
