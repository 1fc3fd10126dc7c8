# SPDX-License-Identifier: Apache-2.0
"""The package `millforce` beside the program `millforce`: the same numbers, the same refusals."""
import json
import os
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import millforce
import numpy as np

ROOT = Path(os.environ["MILLFORCE_SOURCE_DIR"])
PROGRAM = os.environ["MILLFORCE_PROGRAM"]
MACHINE = ROOT / "sim/scenarios/machines/vmc.toml"
TOOL = ROOT / "sim/scenarios/tools/endmill_10mm.toml"
SLOT = ROOT / "sim/scenarios/slot_entry.toml"
AXIS = ROOT / "tests/data/ball_screw_axis_200hz.csv"
CUTS = ROOT / "tests/data/milling_6061_train.csv"


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=100, check=False)


def printed(values):
    """As the program writes a trace: eight significant digits."""
    return np.array([float(f"{value:.8g}") for value in values])


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def assert_same(self, ours, theirs, columns):
        for name in columns:
            np.testing.assert_array_equal(ours[name], theirs[name], name)

    def assert_refused(self, part, function, *arguments, **options):
        with self.assertRaises(millforce.InputError) as refused:
            function(*arguments, **options)
        self.assertIn(part, str(refused.exception))


class SameAsTheProgram(WithFolder):
    def test_a_simulated_run_its_recording_and_its_replay(self):
        ended = program("simulate", SLOT, "--record", "--seed", "7", "--out", self.folder)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        run = millforce.simulate(SLOT, seed=7, recording=self.folder / "ours.csv")

        self.assertEqual((self.folder / "ours.csv").read_bytes(), (self.folder / "recording.csv").read_bytes())
        trace = millforce.read_csv(self.folder / "trace.csv")
        self.assertEqual(set(trace) - {"controller"}, set(run.trace))
        texts = {"state", "limit", "fault", "cut_side"}
        self.assert_same(run.trace, trace, texts)
        self.assert_same({name: printed(run.trace[name]) for name in set(run.trace) - texts}, trace,
                         set(run.trace) - texts)
        figures = json.loads((self.folder / "summary.json").read_text())["runs"][0]
        beside_others = {name for name in figures if name.startswith("time_saved")}
        for name in set(figures) - beside_others - {"real_time_factor"}:
            self.assertEqual(run.figures[name], figures[name], name)

        ended = program("replay", self.folder / "recording.csv", "--machine", MACHINE, "--tool", TOOL, "--interval",
                        "0", "-o", self.folder / "estimates.csv")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        theirs = millforce.read_csv(self.folder / "estimates.csv")
        ours = millforce.replay(self.folder / "recording.csv", millforce.Parameters(MACHINE, TOOL))
        self.assertGreater(np.isfinite(ours["axial_depth_mm"]).sum(), 1000)
        for name in theirs:
            same = ours[name] if name in texts | {"time_s"} else ours[name].astype(np.float32)
            np.testing.assert_array_equal(same, theirs[name].astype(same.dtype), name)

    def test_calibrations_from_files_and_from_arrays(self):
        for command, function, data in (("friction", millforce.calibrate_friction, AXIS),
                                        ("cutting", millforce.calibrate_cutting, CUTS)):
            output = self.folder / f"{command}.toml"
            ended = program("calibrate", command, data, "-o", output)
            from_file, from_arrays = function(data), function(millforce.read_csv(data))
            self.assertEqual(from_file.parameters, millforce.tomllib.loads(output.read_text()))
            self.assertEqual(from_file.report, ended.stdout)
            self.assertEqual(from_file.bound_holds, ended.returncode == 0)
            self.assertEqual(from_arrays.parameters, from_file.parameters)
        self.assertGreater(from_file.parameters["cutting"]["k_s_N_per_mm2_se"], 0)

    def test_kim_and_chungs_procedure_from_arrays(self):
        folder = ROOT / "sim/scenarios/commissioning"
        recording = self.folder / "standard.csv"
        millforce.simulate(folder / "standard_cut_x.toml", recording=recording)
        cuts, library = folder / "standard_cut_x_cuts.csv", ROOT / "sim/scenarios/tools/coefficients.toml"
        ended = program("calibrate", "standard-cut", recording, "--cuts", cuts, "--machine", MACHINE, "--database",
                        library, "--entry", "SM45C_carbide", "-o", self.folder / "gains.toml")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        fit = millforce.calibrate_standard_cut(millforce.read_csv(recording), millforce.read_csv(cuts),
                                               millforce.tomllib.loads(MACHINE.read_text()), library,
                                               entry="SM45C_carbide")
        self.assertEqual(fit.parameters, millforce.tomllib.loads((self.folder / "gains.toml").read_text()))
        spindle = fit.parameters["spindle"]
        self.assertLess(abs(spindle["K_t1_Nm_per_A"] - 0.7), 3 * spindle["K_t1_Nm_per_A_se"])  # 0.7: the plant's

    def test_gains_of_a_spindle_come_back_from_made_up_torques(self):
        random = np.random.default_rng(1)
        current_A = np.repeat(np.arange(2.0, 12.0), 3)
        torque_Nm = 0.7 * current_A - 0.95
        table = {"spindle_current_A": current_A + random.normal(0, 0.01, current_A.size),
                 "spindle_torque_Nm": torque_Nm, "spindle_speed_rad_s": np.full(current_A.size, 400.0)}
        spindle = millforce.calibrate_spindle(table).parameters["spindle"]
        self.assertLess(abs(spindle["K_t1_Nm_per_A"] - 0.7), 3 * spindle["K_t1_Nm_per_A_se"])
        self.assertLess(spindle["K_t1_Nm_per_A_se"], 0.01)

    def test_what_the_program_refuses(self):
        table = millforce.read_csv(CUTS)
        table["feed_mm_s"][0] = -1.0
        self.assert_refused("data_1.csv:2: column 'feed_mm_s'", millforce.calibrate_cutting, table)
        (self.folder / "cut.csv").write_text(CUTS.read_text().splitlines()[0] + "\n")
        for command, function, data in (("friction", millforce.calibrate_friction, self.folder / "none.csv"),
                                        ("cutting", millforce.calibrate_cutting, self.folder / "cut.csv")):
            ended = program("calibrate", command, data, "-o", self.folder / "out.toml")
            self.assertEqual(ended.returncode, 2)
            self.assert_refused(ended.stderr.removeprefix("millforce: ").strip(), function, data)


class MoreOfTheReplay(WithFolder):
    """Columns and files that only some recordings have."""

    def assert_as_replayed(self, samples, parameters, columns, *tool_words):
        millforce.write_csv(self.folder / "samples.csv", samples)
        ended = program("replay", self.folder / "samples.csv", "--machine", MACHINE, *tool_words, "--interval", "0", "-o",
                        self.folder / "estimates.csv")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        theirs = millforce.read_csv(self.folder / "estimates.csv")
        ours = millforce.replay(samples, parameters)
        for name in columns:
            np.testing.assert_array_equal(ours[name].astype(np.float32), np.nan_to_num(theirs[name].astype(np.float32))
                                          if name == "tool" else theirs[name].astype(np.float32), name)
        return ours

    def test_wide_band_columns_of_a_force_sensor(self):
        tool = ROOT / "sim/scenarios/tools/facemill_40mm_dynamometer.toml"
        millforce.simulate(ROOT / "sim/scenarios/face_mill_dynamometer.toml", recording=self.folder / "cut.csv")
        samples = {name: column[:30000] for name, column in millforce.read_csv(self.folder / "cut.csv").items()}
        wide_band = ("force_drop_immersion", "force_drop_immersion_sd", "depth_shape_axial_depth_mm",
                     "depth_shape_radial_variation_percent")
        ours = self.assert_as_replayed(samples, millforce.Parameters(MACHINE, tool), wide_band, "--tool", tool)
        self.assertGreater(np.isfinite(ours["force_drop_immersion"]).sum(), 100)

    def test_tools_by_number(self):
        (self.folder / "tools").mkdir()
        text = TOOL.read_text()
        (self.folder / "tools/T3.toml").write_text(text)
        (self.folder / "tools/T20.toml").write_text(text.replace("teeth = 4", "teeth = 3"))
        tools = millforce.read_tools(MACHINE, self.folder / "tools")
        self.assertEqual({number: one.tool["tool"]["teeth"] for number, one in tools.items()}, {3: 4, 20: 3})
        millforce.simulate(SLOT, recording=self.folder / "slot.csv")
        samples = millforce.read_csv(self.folder / "slot.csv")
        samples["tool"] = np.where(samples["time_s"] < -0.5, 20.0, 3.0)
        ours = self.assert_as_replayed(samples, tools, ("tool", "axial_depth_mm", "peak_force_N", "override"), "--tools",
                                       self.folder / "tools")
        self.assertEqual(set(ours["tool"]), {3, 20})
        del samples["tool"]
        self.assert_refused("no column 'tool'", millforce.replay, samples, tools)
        self.assert_refused("one machine for all", millforce.Tick, {})

    def test_a_part_map_is_read_asked_changed_and_written(self):
        ended = program("preview", ROOT / "sim/scenarios/pocket.ngc", "--stock", ROOT / "sim/scenarios/pocket.toml",
                        "--tool", TOOL, "-o", self.folder / "pocket.map")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        part = millforce.PartMap.read(self.folder / "pocket.map")
        self.assertEqual((part.program, part.tool), ("pocket.ngc", "endmill_10mm"))
        part.write(self.folder / "again.map")
        self.assertEqual((self.folder / "again.map").read_bytes(), (self.folder / "pocket.map").read_bytes())

        table = part.table
        row = np.flatnonzero(np.isfinite(table["axial_depth_mm"]))[0]
        arcs = part.arcs_at(table["path_mm"][row] + 1e-6)
        self.assertEqual(arcs[0], tuple(table[name][row] for name in ("entry_deg", "exit_deg", "axial_depth_mm")))
        self.assertEqual(part.arcs_at(-1.0), [])

        shallow = dict(table, axial_depth_mm=0.5 * table["axial_depth_mm"])
        made = millforce.PartMap.of(shallow, ROOT / "sim/scenarios/pocket.ngc", "endmill_10mm",
                                    millforce.Parameters(MACHINE, TOOL))
        self.assertEqual(made.arcs_at(table["path_mm"][row])[0][2], 0.5 * arcs[0][2])
        made.write(self.folder / "shallow.map")
        self.assertEqual((self.folder / "shallow.map").read_text().splitlines()[:3],
                         (self.folder / "pocket.map").read_text().splitlines()[:3])
        self.assertEqual(set(made.table["known"]), set(table["known"]))
        self.assertGreater(len(set(table["least_share"])), 2)  # the blank may be half a millimetre off
        exact = {name: table[name] for name in millforce.PartMap.COLUMNS}
        self.assertEqual(set(millforce.PartMap.of(exact, ROOT / "sim/scenarios/pocket.ngc", "endmill_10mm",
                                                  millforce.Parameters(MACHINE, TOOL)).table["known"]), {2})
        table["path_mm"][row] = -5.0
        self.assert_refused("map.csv:", millforce.PartMap.of, table, ROOT / "sim/scenarios/pocket.ngc", "endmill_10mm",
                            millforce.Parameters(MACHINE, TOOL))


class TickOnArrays(WithFolder):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            millforce.simulate(SLOT, recording=Path(folder, "recording.csv"))
            cls.recording = millforce.read_csv(Path(folder, "recording.csv"))
        cls.parameters = millforce.Parameters(MACHINE, TOOL)

    def part(self, rows):
        return {name: column[rows] for name, column in self.recording.items()}

    def test_pieces_give_what_the_whole_gives(self):
        whole = millforce.replay(self.recording, self.parameters)
        tick = millforce.Tick(self.parameters)
        pieces = [tick.step(self.part(rows)) for rows in (slice(0, 3001), slice(3001, 3001), slice(3001, None))]
        for name in whole:
            np.testing.assert_array_equal(np.concatenate([piece[name] for piece in pieces]), whole[name], name)

    def test_nan_is_no_measurement_and_gives_no_estimate(self):
        blind = dict(self.recording, spindle_current_A=np.full_like(self.recording["time_s"], np.nan))
        estimates = millforce.replay(blind, self.parameters)
        self.assertTrue(np.isnan(estimates["tangential_force_N"]).all())
        self.assertTrue(np.isfinite(estimates["override"]).all())

    def test_bad_samples_are_refused_with_their_row(self):
        infinite = dict(self.recording, x_current_A=self.recording["x_current_A"].copy())
        infinite["x_current_A"][5] = np.inf
        self.assert_refused("samples: row 5: column 'x_current_A'", millforce.replay, infinite, self.parameters)
        backwards = {name: column[::-1] for name, column in self.recording.items()}
        self.assert_refused("expected a time that grows", millforce.replay, backwards, self.parameters)
        short = dict(self.recording, x_current_A=self.recording["x_current_A"][:-1])
        self.assert_refused("column 'x_current_A' has", millforce.replay, short, self.parameters)
        nameless = {name: column for name, column in self.recording.items() if name != "time_s"}
        self.assert_refused("no column 'time_s'", millforce.replay, nameless, self.parameters)
        tick = millforce.Tick(self.parameters)
        tick.step(self.part(slice(0, 10)))
        other = dict(self.part(slice(10, 20)))
        del other["override"]
        self.assert_refused("other columns than before", tick.step, other)


class ParametersOfDictionaries(WithFolder):
    def test_what_a_file_holds_a_dictionary_holds(self):
        machine = millforce.tomllib.loads(MACHINE.read_text())
        tool = millforce.tomllib.loads(TOOL.read_text())
        from_files = millforce.Parameters(MACHINE, TOOL)
        from_dictionaries = millforce.Parameters(machine, tool)
        self.assertEqual(from_dictionaries.machine, from_files.machine)
        self.assertEqual(from_dictionaries.tool, from_files.tool)
        self.assertEqual(from_files.machine["spindle"]["K_t1_Nm_per_A"], machine["spindle"]["K_t1_Nm_per_A"])
        machine["spindle"]["K_t1_Nm_per_A"] = np.float64(0.8)
        self.assertEqual(millforce.Parameters(machine, TOOL).machine["spindle"]["K_t1_Nm_per_A"], 0.8)

    def test_refusals_name_the_key(self):
        tool = millforce.tomllib.loads(TOOL.read_text())
        tool["tool"]["teeht"] = 3
        self.assert_refused("teeht", millforce.Parameters, MACHINE, tool)
        tool["tool"] = {"teeth": object()}
        self.assert_refused("teeth: object", millforce.Parameters, MACHINE, tool)
        self.assert_refused("none.toml", millforce.Parameters, self.folder / "none.toml", TOOL)


class PlantStepByStep(WithFolder):
    def test_a_function_mills_what_the_same_overrides_mill(self):
        plant = millforce.Plant(SLOT)
        self.assertEqual(plant.hello["scenario"], "slot_entry")
        self.assertEqual(plant.sample["sample"], 1)
        while plant.sample is not None:
            plant.step({"override": 1.0 if plant.sample["rapid"] else 0.75, "axial_depth_mm": 3.0})
        constant = millforce.simulate(SLOT, 0.75)
        by_function = millforce.simulate(SLOT, lambda sample: 1.0 if sample["rapid"] else 0.75)
        self.assertEqual(plant.run().figures["peak_over_limit"], constant.figures["peak_over_limit"])
        truth = [name for name in constant.trace if name.startswith("true_")]
        self.assert_same(by_function.trace, constant.trace, [*truth, "time_s", "x_mm", "tangential_force_N"])
        self.assertEqual(set(plant.run().trace["axial_depth_mm"]), {3.0})
        self.assert_refused("the run has ended", plant.step, 1.0)

    def test_overrides_that_no_cnc_takes_are_refused(self):
        plant = millforce.Plant(SLOT)
        for answer, part in ((float("nan"), "expected a JSON object"), (99.0, "override is 99"),
                             ({"hold": True}, "no key override"), ({"override": 1, "sample": 5}, "sample is 5")):
            self.assert_refused(part, plant.step, answer)
        self.assertEqual(plant.step(1.0)["sample"], 2)

    def test_scenarios_and_controllers_that_do_not_exist(self):
        self.assert_refused("none.toml", millforce.simulate, self.folder / "none.toml")
        self.assert_refused("expected a number, a function, or one of millforce", millforce.simulate, SLOT, "magic")
        self.assert_refused("expected a constant override", millforce.simulate, SLOT, float("nan"))

    def test_other_threads_run_while_the_plant_does(self):
        thread = threading.Thread(target=millforce.simulate, args=(SLOT,))
        thread.start()
        turns = 0
        while thread.is_alive():
            turns += 1
        self.assertGreater(turns, 1000)


if __name__ == "__main__":
    unittest.main()
