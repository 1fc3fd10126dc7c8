// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate spindle` was called with.
struct SpindleCalibrationOptions {
    std::vector<std::filesystem::path> data;
    std::filesystem::path output;
    double low_pass_hz = 5.0;  ///< corner for all columns of a recording that has a spindle angle
};

/// Torque constant of the spindle from known torques: estimation::fit_spindle.
///
/// Columns: spindle_current_A; spindle_torque_Nm, the known torque of the cut (0 when idle; an empty cell is a row
/// whose torque is not known, and is left out); and the speed, either as spindle_speed_rad_s or as spindle_angle_rad
/// with time_s. Optional: spindle_acceleration_rad_s2. With an angle the rows must be evenly spaced in time: the angle
/// is unwrapped, and angle, current and torque pass the same zero-phase low-pass.
///
/// Two speeds or more: the idle torque's slope is fitted. Speeds apart by more than a fifth: field weakening is looked
/// for. Acceleration of more than 1 rad/s²: the inertia is fitted.
///
/// Rows far from the fit are left out and named (estimation::fit_spindle_without_outliers), in a recording spikes of
/// the current are replaced; rows of a table that repeat another one exactly count once. A term whose standard error is
/// larger than its value is left out: the fit is made without it, and it is not written; nor is a term that the rows
/// cannot show.
///
/// Prints the fit on `out`, writes `output`, returns 0, or 1 where a speed may be in another unit
/// (ask_about_spindle_speeds). Throws InputError for bad data, for a reversed sign or a wrong
/// unit, where a fifth of the rows are outliers, and where the data cannot determine a parameter: it names the
/// parameter and what to measure.
int calibrate_spindle(const SpindleCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
