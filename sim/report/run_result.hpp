// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "files/csv.hpp"
#include "report/page_origin.hpp"

/// What a simulated run leaves behind: a trace, one point per interval, and its figures. Reports, CSV and JSON are
/// written from it and from nothing else.

namespace millforce::sim {

/// One interval of the run (about 20 ms, or one revolution where that is longer). Truth comes from the plant; estimates
/// are the controller's, NaN where it had none.
struct TracePoint {
    double time_s = 0.0;
    double path_mm = 0.0;
    double x_mm = 0.0;
    double y_mm = 0.0;
    double z_mm = 0.0;
    double feed_mm_s = 0.0;  ///< true path speed
    double programmed_feed_mm_s = 0.0;
    double override_ratio = 0.0;
    std::uint8_t state = 0;  ///< control::CutState
    std::uint8_t limit = 0;  ///< control::Limit
    std::uint8_t fault = 0;  ///< control::Fault
    bool rapid = false;

    double true_tooth_force_N = 0.0;                   ///< largest in-plane force of one tooth in the interval
    double true_peak_force_N = 0.0;                    ///< largest total in-plane force in the interval
    double true_tangential_force_N = 0.0;              ///< mean F_at in the interval
    double true_feed_force_N = 0.0;                    ///< mean F_ax in the interval
    double true_radial_immersion = host::no_estimate;  ///< NaN in air
    double true_axial_depth_mm = host::no_estimate;

    double tangential_force_N = host::no_estimate;
    double feed_force_N = host::no_estimate;
    double radial_immersion = host::no_estimate;
    double radial_immersion_sd = host::no_estimate;
    double axial_depth_mm = host::no_estimate;
    double axial_depth_sd_mm = host::no_estimate;
    double tooth_force_N = host::no_estimate;
    double peak_force_N = host::no_estimate;
    double force_limit_N = host::no_estimate;  ///< the threshold on the total force, F_tooth,max · g
    double runout_um = host::no_estimate;
    double law_misfit = host::no_estimate;
    std::uint8_t side = 0;  ///< estimation::CutSide, where there is a law_misfit
};

/// The figures of one run.
struct RunFigures {
    double time_s = 0.0;
    double cutting_time_s = 0.0;
    double path_mm = 0.0;
    double peak_tooth_force_N = 0.0;
    double peak_over_limit = 0.0;       ///< largest true tooth force / tooth limit
    double time_over_limit_s = 0.0;     ///< true tooth force above its limit
    double longest_over_limit_s = 0.0;  ///< longest stretch of revolutions with a peak above the limit
    double reaction_time_s = 0.0;       ///< override latency + deceleration + 2 revolutions: what physics allows
    double late_over_limit_s = 0.0;     ///< above the limit though the engagement has not grown for the reaction time
    int teeth_broken = 0;               ///< teeth whose force reached limit × break_share
    double mean_override = 0.0;         ///< over cutting time
    double mean_force_use = 0.0;        ///< mean of true tooth force / limit over cutting time

    double tangential_error = host::no_estimate;  ///< rms error of F_at in cut over the rms of the true one
    double feed_force_error = host::no_estimate;  ///< the same of F_ax

    double immersion_rms = host::no_estimate;       ///< error of the estimate over samples with an estimate
    double immersion_coverage = host::no_estimate;  ///< share of them within the estimate's 95 % band
    double depth_rms_mm = host::no_estimate;
    double depth_coverage = host::no_estimate;
    double estimate_share = 0.0;    ///< share of cutting samples that had an immersion estimate
    double depth_share = 0.0;       ///< the same for the depth
    double real_time_factor = 0.0;  ///< simulated time per wall-clock time
    std::string fault = "none";
    bool finished = false;  ///< the part program came to its end
};

struct RunResult {
    std::string controller;  ///< "millforce", "millforce_fixed", "constant", "constant_hindsight"
    std::vector<TracePoint> trace;
    RunFigures figures;
};

/// What the runs have in common.
struct ScenarioInfo {
    std::string name;
    std::string title;
    std::string description;
    std::string tool;      ///< e.g. "4 flutes, Ø10 mm, helix 30°"
    std::string material;  ///< e.g. "SM45C"
    std::uint64_t seed = 0;
    double tooth_force_limit_N = 0.0;
    double cutter_diameter_mm = 0.0;
    double spindle_speed_rad_s = 0.0;
    double constant_feed_mm_s = 0.0;   ///< the constant feed that is safe everywhere, the baseline's
    double hardest_material = 1.0;     ///< for a K_s so many times as high, too
    double hindsight_feed_mm_s = 0.0;  ///< the best constant feed for exactly this material; 0: not sought
    host::Facts origin{};              ///< machine, tool, program, command, date
    bool has_top_view = false;         ///< the path is a real one in x and y
    double stock_min_x_mm = 0.0;
    double stock_min_y_mm = 0.0;
    double stock_max_x_mm = 0.0;
    double stock_max_y_mm = 0.0;
};

[[nodiscard]] inline double spindle_speed_rpm(const ScenarioInfo& info) {
    return info.spindle_speed_rad_s * 30.0 / std::numbers::pi;
}

}  // namespace millforce::sim
