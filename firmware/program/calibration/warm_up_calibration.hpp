// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate warm-up` was called with.
struct WarmUpCalibrationOptions {
    std::filesystem::path data;     ///< a recording of the spindle idling from cold
    std::filesystem::path machine;  ///< file whose K_t1 turns the current into a torque
    std::filesystem::path output;
};

/// Warm-up of the spindle bearing: T_idle(t) = T_warm + T_cold e^(−t/τ), from a recording (time_s, spindle_angle_rad,
/// spindle_current_A) of the spindle idling at one speed from cold. Rows during the run-up are left out; the others are
/// averaged second by second.
///
/// Prints T_cold and τ with standard errors, and writes warm_up_torque_Nm, warm_up_time_s and warm_up_torque_sd_Nm (a
/// third of the torque: how warm the spindle is when the controller starts is not known). Returns 0, or 1 where the
/// speed may be in another unit. Throws InputError for bad data, for a current or a speed that no idling spindle has,
/// where the torque does not fall, and if the record is too short to determine τ: it says how long is enough.
int calibrate_warm_up(const WarmUpCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
