// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/plausible_units.hpp"

#include <filesystem>
#include <vector>

namespace millforce::host {

/// An evenly sampled recording of one axis.
struct AxisMotion {
    std::vector<double> velocity_m_s;
    std::vector<double> acceleration_m_s2;
    std::vector<double> motor_force_N;
    double dt_s = 0.0;
};

/// Reads time_s, position_m and motor_force_N and filters them; see calibrate_friction. The samples must be evenly
/// spaced (within 1 % of their mean distance): an InputError names the first line that is not. An axis faster than
/// 5 m/s is refused, too: its position is in another unit.
AxisMotion read_axis_motion(const std::filesystem::path& file, double low_pass_hz);

/// One stretch of steady feed in air.
struct SteadyFeed {
    double feed_m_per_min = 0.0;  ///< signed.
    double current_A = 0.0;
    double duration_s = 0.0;
    double middle_s = 0.0;  ///< time of its middle
};

/// What a recording shows of one axis.
struct RecordedFeeds {
    bool is_recorded = false;  ///< velocity and current are there
    std::vector<SteadyFeed> feeds;
    UnitQuestions questions;  ///< about its units; see AxisMotionUnits
};

/// Steady stretches of one axis of a recording. The velocity stays within 3 % (or 0.3 mm/s) of its mean for at least
/// 0.2 s, not counting the first 0.1 s and the last 0.05 s. Throws InputError for bad data, above 3000 mm/s, and for an
/// acceleration or a travel that no axis has.
RecordedFeeds read_steady_feeds(const std::filesystem::path& file, char axis, double minimum_speed_mm_s);

/// Whether the file has the columns of a single axis (position_m), and not those of a recording.
bool is_axis_motion(const std::filesystem::path& file);

}  // namespace millforce::host
