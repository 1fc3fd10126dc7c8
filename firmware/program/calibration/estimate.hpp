// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"

#include <filesystem>
#include <ostream>

namespace millforce::host {

/// What `millforce estimate` was called with.
struct EstimateOptions {
    std::filesystem::path conditions;
    std::filesystem::path tool;    ///< TOML with a [cutting] table, as `millforce calibrate cutting` writes it.
    std::filesystem::path output;  ///< empty: the CSV goes to `out`.
    estimation::CutSide side = estimation::CutSide::unknown;  ///< unknown: cut_side of the tool's file.
};

/// Forces from conditions, and depth or width from measured torque, row by row. The rows of `conditions` are repeated
/// unchanged, with eight columns appended: predicted_spindle_torque_Nm, predicted_normal_force_N,
/// axial_depth_from_torque_mm (needs the width), radial_width_from_torque_mm (needs the depth), each followed by its
/// _sd. An empty cell is "no estimate": the row lacks what it takes, the measured torque is not positive, or it is more
/// than a slot of this depth can take.
///
/// With neither depth nor width known there is no estimate of either: torque and normal force keep nearly the same
/// ratio over most widths, and torque alone is a product of the two.
///
/// With an output file, a summary goes to `out`: how many rows lie outside the calibrated chip thickness, and errors
/// where values were measured. Returns 0. Throws InputError for bad input.
int estimate(const EstimateOptions& options, std::ostream& out);

/// A law, the side it was calibrated on.
struct ToolLaw {
    estimation::CuttingLaw<double> law;
    estimation::CutSide side = estimation::CutSide::down;
};

/// Reads the [cutting] table of a TOML file; other tables may hold anything. InputError names file, line, column, key,
/// and the nearest known key of an unknown one.
ToolLaw read_tool_law(const std::filesystem::path& file);

/// A value and its standard deviation; NaN: no estimate.
struct Estimated {
    double value = no_estimate;
    double sd = no_estimate;
};

/// The estimates of one row.
struct RowEstimates {
    Estimated spindle_torque_Nm;
    Estimated normal_force_N;
    Estimated axial_depth_mm;
    Estimated radial_width_mm;
    double chip_thickness_mm = no_estimate;
};

RowEstimates estimate_row(const estimation::CuttingLaw<double>& law, estimation::CutSide side, const CutRow& row);

}  // namespace millforce::host
