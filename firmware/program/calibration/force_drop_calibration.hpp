// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <ostream>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate force-drop` and `calibrate tip-angle` were asked for.
struct ForceShapeCalibrationOptions {
    std::vector<std::filesystem::path> data;  ///< recordings with fx_N, fy_N; or of drives whose axes both travel
    std::filesystem::path cuts;               ///< table of cuts; see recorded_cuts.hpp
    std::filesystem::path machine;
    std::filesystem::path tool;  ///< file with side, teeth, [force_sensor]
    std::filesystem::path output;
};

/// Table [force_drop] of a tool: edge lengths, r = a r_av + b and ln K/K_av from cuts of known immersion (Hwang et al.,
/// estimation_calibration/force_drop_calibration.hpp). Each cut is then estimated by the law of the others. Returns 0,
/// or 1 where one of them is off by more than 10 %, or a unit is asked for (look_at_recorded_forces). Throws InputError
/// for bad data, for fewer than four different cuts, where the forces follow no cutting law (axes swapped or reversed),
/// and where the cuts do not determine the law: it names what is missing. The law is used down to the narrowest of the
/// cuts.
int calibrate_force_drop(const ForceShapeCalibrationOptions& options, std::ostream& out);

/// tip_angle_deg of table [depth_shape]: the angle of the teeth at the encoder's zero, from cuts of known depths
/// (estimation/depth_shape/flute_profile_fit.hpp). Several cuts are averaged by their standard deviations. Returns 0,
/// or 1 where they disagree by more than four of them, or a unit is asked for. Throws InputError for bad data, and if
/// no cut determines the angle.
int calibrate_tip_angle(const ForceShapeCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
