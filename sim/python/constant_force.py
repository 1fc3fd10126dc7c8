#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the mean tangential force of a cut: python3 constant_force.py SOCKET [NEWTONS]"""
import json, pathlib, socket, sys

path, target_N = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 300.0
pathlib.Path(path).unlink(missing_ok=True)
with socket.socket(socket.AF_UNIX) as listener:
    listener.bind(path)
    listener.listen()
    lines = listener.accept()[0].makefile("rw", buffering=1)

hello = json.loads(lines.readline())
spindle, cnc = hello["machine"]["spindle"], hello["machine"]["cnc"]
radius_m = hello["tool"]["tool"]["diameter_mm"] / 2000
answer = {"type": "ready", "version": 1, "name": "constant force"}
force_N, ratio = 0.0, cnc["override_min"]
while True:
    lines.write(json.dumps(answer) + "\n")
    message = json.loads(lines.readline())
    if message["type"] != "sample":
        sys.exit(message.get("message"))  # none at the end of a run
    torque_Nm = spindle["K_t1_Nm_per_A"] * message["spindle_current_A"] + spindle["K_t2_Nm"]
    force_N += 0.02 * (torque_Nm / radius_m - force_N)  # 50 samples of smoothing
    ratio += 0.002 * (1 - force_N / target_N)  # at twice the target it falls by 1 in 0.5 s
    ratio = min(max(ratio, cnc["override_min"]), 1.0)
    answer = {"override": ratio}
