# SPDX-License-Identifier: Apache-2.0
"""Runs the cells of the notebook from top to bottom, as Jupyter would, and judges what they have worked out. Jupyter
itself would install some forty packages more."""
import contextlib
import io
import json
import os
import unittest
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

FOLDER = Path(os.environ["MILLFORCE_SOURCE_DIR"]) / "sim/python"
NOTEBOOK = FOLDER / "from_recording_to_immersion.ipynb"


def code_cells():
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in cells if cell["cell_type"] == "code"]


class Notebook(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.values = {}
        cls.printed = io.StringIO()
        before = os.getcwd()
        os.chdir(FOLDER)
        try:
            with contextlib.redirect_stdout(cls.printed):
                for place, cell in enumerate(code_cells()):
                    exec(compile("".join(cell["source"]), f"cell {place}", "exec"), cls.values)
        finally:
            os.chdir(before)

    def test_it_is_kept_without_outputs(self):
        for cell in code_cells():
            self.assertEqual(cell["outputs"], [])
            self.assertIsNone(cell["execution_count"])

    def test_forces_immersion_and_depth_are_those_of_the_truth(self):
        self.assertLess(self.values["force_error_share"], 0.06)
        self.assertLess(self.values["immersion_rms"], 0.1)
        self.assertGreater(self.values["immersion_coverage"], 0.95)
        self.assertLess(self.values["depth_rms_mm"], 1.5)
        self.assertGreater(self.values["known"].mean(), 0.9)

    def test_the_friction_is_that_of_the_measured_axis(self):
        friction = self.values["friction"]
        self.assertAlmostEqual(friction["mass_kg"], 95.11, delta=0.02 * 95.11)
        self.assertAlmostEqual(friction["viscous_N_s_per_m"], 203.5, delta=0.02 * 203.5)
        self.assertAlmostEqual(friction["coulomb_N"], 20.39, delta=0.02 * 20.39)

    def test_each_width_is_found_within_ten_percent_of_the_radius(self):
        np.testing.assert_allclose(self.values["estimated"], self.values["actual"], atol=0.1)

    def test_every_plot_is_drawn(self):
        figures = [plt.figure(number) for number in plt.get_fignums()]
        self.assertEqual(len(figures), 6)
        for figure in figures:
            figure.canvas.draw()
            self.assertTrue(all(plot.lines for plot in figure.axes))

    def test_nothing_is_left_in_the_folder(self):
        self.assertFalse(list(FOLDER.glob("*.csv")) + list(FOLDER.glob("*.toml")))


if __name__ == "__main__":
    unittest.main()
