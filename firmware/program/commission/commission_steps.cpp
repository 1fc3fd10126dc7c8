// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "calibration/calibration_report.hpp"
#include "calibration/friction_calibration.hpp"
#include "commission/commissioning.hpp"
#include "commission/cut_watch.hpp"
#include "estimation/cutting/cutting_law.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

constexpr double mm_min_per_m_per_min = 1000.0;

std::string air_verdict(bool is_sound, const std::string& report) {
    if (is_sound) {
        return "friction of each axis is a function of the feed and did not change";
    }
    return report.find("BROKEN") != std::string::npos
               ? "the friction changed while it was measured; move the axes for ten minutes, "
                 "then start again with --repeat air"
               : "a current or a velocity may be in another unit, see the warning; correct it, then start again with "
                 "--repeat air";
}

}  // namespace

bool Commissioning::idle() {
    idle_watch_ = std::make_unique<IdleWatch>(counts_per_rev(), plan_.idle_rpm.size(), plan_.idle_dwell_s);
    if (!watch("idle", *idle_watch_, true, "The tool is in air, the axes rest; best after ten minutes of running.")) {
        return false;
    }
    const auto fit = idle_watch_->fit();
    if (!fit) {
        throw std::logic_error("idle: enough, and no fit");
    }
    idle_ = *fit;
    constexpr double largest_share = 0.05;
    constexpr double per_1000_rpm = 1000.0 * std::numbers::pi / 30.0;  // of rad/s
    const double middle_A = std::abs(idle_watch_->plateaus().front().current_A);
    judge("idle", idle_.residual_A <= largest_share * middle_A,
          fmt::format("the idle current is {:.4f} ± {:.4f} A at rest, and grows by {:.4f} ± {:.4f} A per 1000/min, to "
                      "within {:.4f} A ({:.1f} %, bound {:.0f} %){}",
                      idle_.offset_A, idle_.offset_se, per_1000_rpm * idle_.slope_A_s, per_1000_rpm * idle_.slope_se,
                      idle_.residual_A, 100.0 * idle_.residual_A / middle_A, 100.0 * largest_share,
                      idle_.residual_A <= largest_share * middle_A
                          ? ""
                          : "; run the spindle warm for ten minutes, then start again with --repeat idle"));
    return true;
}

bool Commissioning::air() {
    std::vector<std::size_t> axes;
    for (const std::string& axis : axes_) {
        axes.push_back(axis_number(axis));
    }
    std::vector<double> feeds;
    for (const double feed : plan_.air_feeds_mm_min) {
        feeds.push_back(feed / mm_min_per_m_per_min);
    }
    air_watch_ = std::make_unique<AirWatch>(axes, feeds);
    if (!watch("air", *air_watch_, true, "The tool is in air; each axis travels in + from where it stands.")) {
        return false;
    }
    std::ostringstream report;
    try {
        FrictionCalibrationOptions friction;
        friction.data = session_.recordings("air");
        friction.output = session_.file("friction.toml");
        const bool is_sound = calibrate_friction(friction, report) == exit_done;
        machine_.merge(session_.file("friction.toml"), "air cuts");
        judge("air", is_sound, air_verdict(is_sound, report.str()), report.str());
        return true;
    } catch (const InputError& error) {
        refuse({"air"}, error);
        return false;
    }
}

CutWatchSettings Commissioning::watch_settings(const std::string& axis, const std::vector<CutPass>& passes) const {
    CutWatchSettings settings;
    settings.counts_per_rev = counts_per_rev();
    settings.axis = axis_number(axis);
    settings.passes = passes;
    settings.tool_diameter_mm = plan_.tool_diameter_mm;
    settings.flutes = plan_.flutes;
    settings.travel_per_motor_turn_mm = plan_.travel_per_motor_turn_mm;
    settings.smallest_rise_A = smallest_rise_A(passes);
    return settings;
}

/// By the published law and the data sheet's torque per ampere.
double Commissioning::smallest_rise_A(const std::vector<CutPass>& passes) const {
    double smallest_A = HUGE_VAL;
    for (const CutPass& pass : passes) {
        const double feed_per_tooth_mm = pass.feed_mm_min / plan_.cut_rpm / plan_.flutes;
        const double radius_mm = 0.5 * plan_.tool_diameter_mm;
        const auto forces = estimation::average_forces<double>(
            entry_.law, {feed_per_tooth_mm, pass.axial_depth_mm,
                         estimation::engagement_angles(plan_.side, pass.radial_width_mm / radius_mm),
                         static_cast<double>(plan_.flutes)});
        const double torque_Nm = forces.tangential_N * 1e-3 * radius_mm;
        smallest_A = std::min(smallest_A, torque_Nm / static_cast<double>(first_.machine.spindle.K_t1_Nm_per_A));
    }
    return smallest_A;
}

/// A recording of cuts counts as a whole: the passes come in their order.
bool Commissioning::cuts(const std::string& kind, const std::vector<CutPass>& passes) {
    for (const std::string& axis : cutting_axes(axes_)) {
        const std::string step = fmt::format("{}_{}", kind, axis);
        if (!session_.has(step + "_cuts.csv") && !record_cuts(step, watch_settings(axis, passes))) {
            return false;
        }
    }
    return true;
}

bool Commissioning::record_cuts(const std::string& step, const CutWatchSettings& settings) {
    for (const auto& recording : session_.recordings(step)) {
        std::filesystem::rename(recording, recording.string() + ".incomplete");
    }
    CutWatch cut_watch(settings);
    const std::string hint = fmt::format("Origin: top corner of the block, {:.1f} mm long or more; {} milling.",
                                         block_length_mm(plan_), name(plan_.side));
    if (!watch(step, cut_watch, false, hint)) {
        return false;
    }
    cut_watch.write_table(session_.file(step + "_cuts.csv"), session_.recordings(step).back());
    return true;
}

}  // namespace millforce::host
