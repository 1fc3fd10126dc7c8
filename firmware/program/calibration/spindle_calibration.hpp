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
    double low_pass_hz = 5.0;  ///< of all columns of a recording that has a spindle angle.
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
/// Prints the fit on `out`, writes `output`, returns 0. Throws InputError for bad data, and where the data cannot
/// determine a parameter: it names the parameter and what to measure.
int calibrate_spindle(const SpindleCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
