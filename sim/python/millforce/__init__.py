# SPDX-License-Identifier: Apache-2.0
"""Sensorless force control for milling, from Python: estimator and controller (Tick), the simulated machine (simulate,
Plant), part maps (PartMap), and the calibrations (calibrate_friction and others).

A table is a dictionary of numpy arrays. Its keys are the columns of the program's CSV files, with their units in their
names: time_s, spindle_angle_rad, spindle_current_A, x_current_A, x_velocity_mm_s … NaN is "no measurement" or
"no estimate". Wherever a table is expected, the path of a CSV file will do.

Bad input raises InputError, a ValueError with the program's message: place, value, what was expected. Long calls leave
the interpreter free for other threads; an object is for one thread at a time."""
from __future__ import annotations

import json
import os
import tempfile
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _millforce
from ._millforce import InputError

__all__ = ["InputError", "Parameters", "Tick", "Plant", "Run", "Fit", "PartMap", "read_csv", "write_csv", "read_tools", "replay",
           "simulate",
           "calibrate_friction", "calibrate_spindle", "calibrate_standard_cut", "calibrate_cutting"]

Table = Mapping[str, ArrayLike]
Arrays = dict[str, np.ndarray]
PathLike = str | os.PathLike[str]
Data = Table | PathLike
Message = dict[str, Any]


# ---- tables and files

def read_csv(path: PathLike) -> Arrays:
    """The columns of a CSV file: numbers, NaN where a cell is empty; text where a cell is no number."""
    names, columns = _millforce.read_cells(os.fspath(path))
    return {name: _numbers_or_text(cells) for name, cells in zip(names, columns)}


def _numbers_or_text(cells: list[str]) -> np.ndarray:
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells, dtype="U")


def write_csv(path: PathLike, table: Table) -> None:
    """Writes a table so that reading it gives the same numbers. NaN becomes an empty cell."""
    columns = [np.asarray(column) for column in table.values()]
    lengths = {column.shape for column in columns}
    if len(lengths) > 1 or any(len(shape) != 1 for shape in lengths):
        raise InputError(f"{os.fspath(path)}: columns of shapes {sorted(lengths)}; expected one length for all")
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(",".join(table) + "\n")
        for row in zip(*(column.tolist() for column in columns)):
            file.write(",".join(map(_cell, row)) + "\n")


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return '"' + value.replace('"', '""') + '"' if set(value) & set(',"\n') else value
    return "" if value != value else repr(value) if isinstance(value, int) else repr(float(value))


def _toml(table: Mapping[str, Any], name: str = "") -> str:
    """A dictionary of dictionaries as TOML: plain values first, then the tables."""
    lines = [f"{json.dumps(key)} = {_toml_value(key, value)}" for key, value in table.items()
             if not isinstance(value, Mapping)]
    for key, value in table.items():
        if isinstance(value, Mapping):
            full = f"{name}.{json.dumps(key)}" if name else json.dumps(key)
            lines += [f"[{full}]", _toml(value, full)]
    return "\n".join(lines) + "\n"


def _toml_value(key: str, value: Any) -> str:
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml_value(key, item) for item in value) + "]"
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    raise InputError(f"{key}: {type(value).__name__}; expected a number, a text, true or false, or a dictionary")


def _text_and_name(given: Mapping[str, Any] | PathLike, name: str) -> tuple[str, str]:
    if isinstance(given, Mapping):
        return _toml(given), name
    try:
        return Path(given).read_text(encoding="utf-8"), os.fspath(given)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{os.fspath(given)}: cannot be read: {error}") from None


# ---- estimator and controller

class Parameters:
    """What the controller knows of a machine and a tool: machine.toml and tool.toml, or dictionaries of their tables,
    e.g. {"tool": {"teeth": 4, "diameter_mm": 10.0, …}, "cutting": {…}}. `millforce parameters` lists all keys.

    Raises InputError for a key that is unknown or missing, and for a value out of its range."""

    def __init__(self, machine: Mapping[str, Any] | PathLike, tool: Mapping[str, Any] | PathLike):
        self._parameters = _millforce.Parameters(*_text_and_name(machine, "machine"), *_text_and_name(tool, "tool"))

    @property
    def machine(self) -> dict[str, dict[str, Any]]:
        """All values in force, with defaults, by table and key; without the bus."""
        return json.loads(self._parameters.machine_json())

    @property
    def tool(self) -> dict[str, dict[str, Any]]:
        """All values in force, with defaults, by table and key."""
        return json.loads(self._parameters.tool_json())


def read_tools(machine: Mapping[str, Any] | PathLike, folder: PathLike) -> dict[int, Parameters]:
    """The tools of a folder by their numbers, as `millforce run --tools`: T1.toml, T2.toml … Each has the same machine."""
    def of_tool(parameters: Any) -> Parameters:
        made = Parameters.__new__(Parameters)
        made._parameters = parameters
        return made
    tools = _millforce.read_tools(*_text_and_name(machine, "machine"), os.fspath(folder))
    return {number: of_tool(parameters) for number, parameters in tools.items()}


class Tick:
    """Estimator and controller, the same code as on a machine, fed with samples.

    >>> tick = Tick(Parameters("machine.toml", "tool.toml"))
    >>> estimates = tick.step(read_csv("recording.csv"))
    >>> plt.plot(estimates["time_s"], estimates["radial_immersion"])

    With several tools, a dictionary of their parameters by number (read_tools): the samples' column `tool` says which
    is in the spindle, NaN and 0: not known. A tool changes where the axes rest and nothing cuts."""

    def __init__(self, parameters: Parameters | Mapping[int, Parameters]):
        if not isinstance(parameters, Mapping):
            self._tick = _millforce.Tick(parameters._parameters)
            return
        if len({json.dumps(one.machine) for one in parameters.values()}) != 1:
            raise InputError("parameters: expected at least one tool, and one machine for all")
        self._tick = _millforce.Tick({number: one._parameters for number, one in parameters.items()})

    def step(self, samples: Data) -> Arrays:
        """One estimate and one override for each sample, after what the calls before have brought.

        `samples`: the columns of a recording. Needed: time_s, spindle_angle_rad, spindle_current_A, and current and
        velocity of one axis; also read: spindle_index_angle_rad, programmed_feed_mm_s, rapid, fx_N, fy_N. Others are
        ignored. Each call needs the same columns. After an InputError begin with a new Tick.

        Returns time_s, state, tangential_force_N, feed_force_N, radial_immersion, radial_immersion_sd, axial_depth_mm,
        axial_depth_sd_mm, peak_force_N, force_limit_N, override, tooth_force_N, limit, fault, runout_um,
        cut_side, law_misfit, hold. NaN, or an empty cut_side, is "no estimate". With several tools also tool, 0: not known. With one, and with fx_N and fy_N or a tool that has
        [force_drop]: force_drop_immersion, depth_shape_axial_depth_mm, depth_shape_radial_width_mm, each with its
        standard deviation, and the two depths' variations from the nominal ones. The forces are means over a tooth period, radial_immersion is a_e/R (0…2), *_sd are standard
        deviations. The numbers are those of `millforce replay --interval 0`. Cost: some 7 µs a sample."""
        table = read_csv(samples) if not isinstance(samples, Mapping) else samples
        numbers = {name: column for name, column in table.items() if np.asarray(column).dtype.kind not in "US"}
        return self._tick.step(list(numbers), [np.asarray(column, dtype=float) for column in numbers.values()])


def replay(samples: Data, parameters: Parameters | Mapping[int, Parameters]) -> Arrays:
    """The estimates of a whole recording: Tick(parameters).step(samples)."""
    return Tick(parameters).step(samples)


# ---- part maps

class PartMap:
    """What a tool meets along its program, as `millforce preview` writes it.

    >>> part = PartMap.read("pocket.map")
    >>> part.arcs_at(150.0)                            # [(11.5, 168.5, 5.0)]
    >>> deeper = dict(part.table, axial_depth_mm=2 * part.table["axial_depth_mm"])
    >>> PartMap.of(deeper, "pocket.ngc", "endmill_10mm", parameters).write("deeper.map")"""

    COLUMNS = ("path_mm", "block_end_mm", "line", "rapid", "feed_mm_min", "spindle_rpm", "entry_deg", "exit_deg",
               "axial_depth_mm")
    DOUBT_COLUMNS = ("known", "arc_sd_deg", "axial_depth_sd_mm", "hardness", "hardness_sd", "position_sd_mm", "contested",
                     "least_share")

    def __init__(self, part_map: Any):
        self._map = part_map

    @classmethod
    def read(cls, path: PathLike) -> PartMap:
        """Raises InputError with file and line for a map that the controller would not take."""
        return cls(_millforce.PartMap(os.fspath(path)))

    @classmethod
    def of(cls, table: Table, program: PathLike, tool: str, parameters: Parameters) -> PartMap:
        """A map of a table with COLUMNS, for this program and this tool: the controller takes it with no other. With
        DOUBT_COLUMNS, too, it says what is not known of a cut; without, each cut is exactly this one.
        Raises InputError as read(), with the lines of a file map.csv."""
        names = cls.COLUMNS + cls.DOUBT_COLUMNS if set(table) >= set(cls.DOUBT_COLUMNS) else cls.COLUMNS
        if set(table) != set(names):
            raise InputError(f"table: columns {', '.join(table)}; expected {', '.join(cls.COLUMNS)}, "
                             f"and all or none of {', '.join(cls.DOUBT_COLUMNS)}")
        whole = ("line", "rapid", "known", "contested")
        columns = {name: np.asarray(table[name], dtype=int if name in whole else float) for name in names}
        version = 2 if names != cls.COLUMNS else 1
        name, crc32, tool_name, tool_crc32 = _millforce.map_origin(os.fspath(program), tool, parameters._parameters)
        with _files() as path_of:
            path = path_of(columns, "map.csv")
            rows = Path(path).read_text(encoding="utf-8")
            Path(path).write_text(f"# millforce part map {version}\n# program {name} crc32 {crc32:08x}\n"
                                  f"# tool {tool_name} crc32 {tool_crc32:08x}\n{rows}", encoding="utf-8")
            return cls.read(path)

    def write(self, path: PathLike) -> None:
        """Writes places that differ from the one before, the file appears whole."""
        self._map.write(os.fspath(path))

    @property
    def program(self) -> str:
        """Name of the program that it belongs to."""
        return self._map.program

    @property
    def tool(self) -> str:
        """Name of the tool that it belongs to."""
        return self._map.tool

    @property
    def table(self) -> Arrays:
        """The columns of the file. A row holds up to the next; further arcs at a place are further rows with the same
        path_mm; NaN in the columns of the arc: air. Angles are from the normal to the feed, 0 to 180 degrees."""
        air = [(np.nan, np.nan, np.nan)]
        rows = [(*place, *arc, *doubt) for (*place, arcs), doubt in self._map.rows() for arc in arcs or air]
        return {name: np.array(column) for name, column in zip(self.COLUMNS + self.DOUBT_COLUMNS, zip(*rows))}

    def arcs_at(self, path_mm: float) -> list[tuple[float, float, float]]:
        """The engaged arcs where this much of the program's path is done: entry and exit in degrees, axial depth in mm.
        Empty: air."""
        return self._map.arcs_at(path_mm)


# ---- the simulated machine

@dataclass(frozen=True)
class Run:
    """A simulated run. `trace`: the columns of trace.csv, about one row each 20 ms, the truth in columns true_*.
    `figures`: the keys of a run in summary.json, such as time_s, peak_over_limit, teeth_broken, finished."""
    trace: Arrays
    figures: dict[str, Any]


def _run(results: tuple[Arrays, str]) -> Run:
    return Run(results[0], json.loads(results[1])["runs"][0])


def simulate(scenario: PathLike, controller: str | float | Callable[[Message], Any] = "millforce", *,
             seed: int | None = None, cutting_force_scale: float | None = None, friction_scale: float | None = None,
             current_noise_share: float | None = None, recording: PathLike | None = None) -> Run:
    """Mills a scenario in closed loop. The same arguments give the same run.

    `controller`: "millforce" or "millforce_fixed"; a number, which is a constant override; or a
    function that is called with each sample's message and returns what Plant.step takes. With the names and a number,
    `recording` is a file for each sample that the controller saw, as `millforce simulate --record` writes it.
    `cutting_force_scale` and `friction_scale` are true values over those the controller knows, `current_noise_share`
    the noise of a current over the rated one. Cost: a second for some 80 simulated ones, with a function for 28."""
    deviation = {"seed": seed, "cutting_force_scale": cutting_force_scale, "friction_scale": friction_scale,
                 "current_noise_share": current_noise_share}
    if callable(controller):
        if recording is not None:
            raise InputError("recording: a function sees each sample itself; expected none")
        plant = Plant(scenario, **deviation)
        while plant.sample is not None:
            plant.step(controller(plant.sample))
        return plant.run()
    ratio = 0.0 if isinstance(controller, str) else float(controller)
    name = controller if isinstance(controller, str) else "constant"
    names = [known for known in _millforce.controller_names() if known != "constant"]
    if isinstance(controller, str) and controller not in names:
        raise InputError(f"controller: '{controller}'; expected a number, a function, or one of {', '.join(names)}")
    if not 0.0 <= ratio <= 9.0:
        raise InputError(f"controller: {ratio}; expected a constant override from 0 to 9")
    return _run(_millforce.simulate(_millforce.Scenario(os.fspath(scenario), **deviation), name, ratio, recording))


class Plant:
    """The simulated machine, one sample at a time: a controller of your own decides on each override.

    >>> plant = Plant("sim/scenarios/depth_ramp.toml")
    >>> while plant.sample is not None:
    ...     plant.step(0.5 if plant.sample["spindle_current_A"] > 6 else 1.0)
    >>> plant.run().figures["peak_over_limit"]

    Messages are those of `millforce simulate --controller socket:PATH`, so a controller can move from one to the other
    as it is. Here a missing number is None."""

    def __init__(self, scenario: PathLike, *, seed: int | None = None, cutting_force_scale: float | None = None,
                 friction_scale: float | None = None, current_noise_share: float | None = None):
        self._plant = _millforce.Plant(_millforce.Scenario(os.fspath(scenario), seed, cutting_force_scale,
                                                           friction_scale, current_noise_share))
        self._sample = json.loads(self._plant.sample)

    @property
    def hello(self) -> Message:
        """Scenario and parameters: hello["machine"] and hello["tool"] by table and key."""
        return json.loads(self._plant.hello)

    @property
    def sample(self) -> Message | None:
        """The sample that waits for its override. None: the run has ended."""
        return self._sample

    def step(self, answer: float | Message) -> Message | None:
        """Answers the sample and returns the next one, None at the end of the run. `answer`: an override, or a
        dictionary with "override", "hold", and estimates of your own for the trace. Raises InputError for an override
        outside of the limits in hello["machine"]["cnc"]."""
        if self._sample is None:
            raise InputError("the run has ended; expected no further override")
        message = answer if isinstance(answer, Mapping) else {"override": answer}
        self._plant.answer(json.dumps(message, default=float))
        line = self._plant.sample
        self._sample = None if line is None else json.loads(line)
        return self._sample

    def run(self, controller: str = "python") -> Run:
        """Trace and figures of what has been milled so far."""
        return _run(self._plant.result(controller))


# ---- calibration

@dataclass(frozen=True)
class Fit:
    """A calibration. `parameters`: tables and keys as they go into machine.toml or tool.toml, each with KEY_se, its
    standard error. `report`: what `millforce calibrate` prints. `bound_holds`: False where it ends with exit code 1."""
    parameters: dict[str, dict[str, Any]]
    report: str
    bound_holds: bool


@contextmanager
def _files() -> Iterator[Callable[[Data | None, str], str]]:
    """Paths for tables and dictionaries: the calibrations read files, and name them in their messages (data_1.csv)."""
    with tempfile.TemporaryDirectory(prefix="millforce-") as folder:
        def path_of(given: Any, name: str) -> str:
            if given is None:
                return ""
            if not isinstance(given, Mapping):
                return os.fspath(given)
            path = Path(folder, name)
            if name.endswith(".toml"):
                path.write_text(_toml(given), encoding="utf-8")
            else:
                write_csv(path, given)
            return str(path)
        try:
            yield path_of
        except InputError as error:
            raise InputError(str(error).replace(folder + os.sep, "")) from None


def _calibrate(calibration: Callable[..., tuple[str, bool]], data: Data | Sequence[Data], files: Mapping[str, Any],
               options: Mapping[str, Any]) -> Fit:
    tables = [data] if isinstance(data, (Mapping, str, os.PathLike)) else list(data)
    with _files() as path_of:
        names = [path_of(table, f"data_{k + 1}.csv") for k, table in enumerate(tables)]
        others = {key: path_of(given, f"{key}.csv" if key == "cuts" else f"{key}.toml")
                  for key, given in files.items()}
        output = path_of({}, "fit.toml")
        report, holds = calibration(data=names, output=output, **others, **options)
        return Fit(tomllib.loads(Path(output).read_text(encoding="utf-8")), report, holds)


def calibrate_friction(data: Data | Sequence[Data], *, axis: str | None = None, low_pass_hz: float | None = None,
                       minimum_speed_mm_s: float | None = None) -> Fit:
    """Friction, mass and weight of feed axes from motion without cutting: a recording of air cuts (time_s,
    AXIS_velocity_mm_s, AXIS_current_A; at least three steady feeds in each direction), or one axis in motion (time_s,
    position_m, motor_force_N), which `axis` names. Of the latter, `low_pass_hz` filters position and force, and slower
    samples than `minimum_speed_mm_s` are left out."""
    return _calibrate(_millforce.calibrate_friction, data, {},
                      {"axis": axis, "low_pass_hz": low_pass_hz, "minimum_speed_mm_s": minimum_speed_mm_s})


def calibrate_spindle(data: Data | Sequence[Data], *, low_pass_hz: float | None = None) -> Fit:
    """Torque per ampere, idle torque and inertia of the spindle from known torques: spindle_current_A,
    spindle_torque_Nm, and spindle_speed_rad_s, or time_s and spindle_angle_rad, which `low_pass_hz` filters."""
    return _calibrate(_millforce.calibrate_spindle, data, {}, {"low_pass_hz": low_pass_hz})


def calibrate_standard_cut(data: Data | Sequence[Data], cuts: Data, machine: Mapping[str, Any] | PathLike,
                           database: PathLike, *, entry: str = "", side: str = "down") -> Fit:
    """Gains of spindle and feed drives from recordings of cuts whose tool and workpiece are in `database`.

    `cuts`, which stretch is which cut: start_s, end_s, tool_diameter_mm, flutes, axial_depth_mm, radial_width_mm (0: in
    air), and `recording` if there are several: tables in memory are data_1.csv, data_2.csv … `machine`: with the
    friction of the air cuts."""
    return _calibrate(_millforce.calibrate_standard_cut, data, {"cuts": cuts, "machine": machine},
                      {"database": os.fspath(database), "entry": entry, "side": side})


def calibrate_cutting(data: Data | Sequence[Data], *, side: str = "unknown", law: str | None = None,
                      cuts: Data | None = None, machine: Mapping[str, Any] | PathLike | None = None) -> Fit:
    """Coefficients of a material and a tool from measured cuts: tool_diameter_mm, flutes, spindle_rad_s,
    axial_depth_mm, radial_width_mm, feed_mm_s, spindle_torque_Nm, and normal_force_N or feed_force_N. Or from recordings
    of drive currents with `cuts` and `machine`, as for calibrate_standard_cut. `side`: down, up or unknown; `law`:
    linear_edge, power or combined."""
    return _calibrate(_millforce.calibrate_cutting, data, {"cuts": cuts, "machine": machine},
                      {"side": side, "law": law})
