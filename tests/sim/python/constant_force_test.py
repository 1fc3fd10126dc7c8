# SPDX-License-Identifier: Apache-2.0
"""The example of a controller in another process: sim/python/constant_force.py."""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from statistics import mean

ROOT = Path(os.environ["MILLFORCE_SOURCE_DIR"])
EXAMPLE = ROOT / "sim/python/constant_force.py"
TARGET_N = 250.0


class ConstantForce(unittest.TestCase):
    def test_it_is_short_and_needs_the_standard_library_alone(self):
        text = EXAMPLE.read_text()
        self.assertLessEqual(len(text.splitlines()), 30)
        self.assertIn("import json, pathlib, socket, sys\n", text)

    def test_it_plays_the_depth_ramp_and_holds_the_force(self):
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder, "controller.sock"))
            with subprocess.Popen([sys.executable, EXAMPLE, path, str(TARGET_N)]) as controller:
                ended = subprocess.run(
                    [os.environ["MILLFORCE_PROGRAM"], "simulate", ROOT / "sim/scenarios/depth_ramp.toml",
                     "--controller", "socket:" + path, "--out", folder],
                    capture_output=True, text=True, timeout=200, check=False)
                self.assertEqual(ended.returncode, 0, ended.stderr)
                self.assertEqual(controller.wait(timeout=20), 0)
            figures = json.loads(Path(folder, "summary.json").read_text())["runs"][0]
            self.assertEqual(figures["controller"], "constant force")
            self.assertTrue(figures["finished"])
            with open(Path(folder, "trace.csv"), encoding="utf-8") as file:
                forces_N = [float(row["true_tangential_force_N"]) for row in csv.DictReader(file)
                            if 60 < float(row["path_mm"]) < 190]
        self.assertLess(abs(mean(forces_N) - TARGET_N), 0.03 * TARGET_N)
        self.assertLess(max(forces_N), 1.25 * TARGET_N)  # the depth grows and falls by 7 % each 10 mm, the law is slow
        self.assertGreater(min(forces_N), 0.75 * TARGET_N)


if __name__ == "__main__":
    unittest.main()
