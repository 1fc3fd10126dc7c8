// SPDX-License-Identifier: Apache-2.0
#include "calibration/drive_forces.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace millforce::host {

namespace {

constexpr std::array<char, 3> axes{'x', 'y', 'z'};

/// κ of a stretch in air. There F_ax = 0, so the current is κ I_f less the part of K_x5/w.
double friction_scale_in_air(const RecordedStretch& air, const MachineParameters& machine) {
    const auto& axis = machine.axes[air.axis];
    const double w = air.feed_m_per_min();
    const double gain = static_cast<double>(axis.K_x4_N_per_A);
    const double by_slowness_A = static_cast<double>(axis.K_x5_N_m_per_min) / w / gain;
    const double friction_A = signed_friction_current_A(machine, air.axis, w);
    return (air.axis_current_A - static_cast<double>(axis.gravity_A) + by_slowness_A) / friction_A;
}

bool is_air_for(const RecordedStretch& stretch, const RecordedStretch& cut) {
    return !stretch.conditions.in_cut() && stretch.conditions.recording == cut.conditions.recording &&
           stretch.axis == cut.axis && stretch.feed_mm_s * cut.feed_mm_s > 0.0;
}

/// The stretches in air before and after a cut; the same one twice if there is air on one side only.
struct Neighbours {
    const RecordedStretch* before = nullptr;
    const RecordedStretch* after = nullptr;

    template <typename Value>
    [[nodiscard]] double at(double time_s, Value value) const {
        const double apart_s = after->middle_s - before->middle_s;
        const double share = apart_s > 0.0 ? (time_s - before->middle_s) / apart_s : 0.0;
        return value(*before) + share * (value(*after) - value(*before));
    }
};

/// `same_feed`: within a tenth. Friction's shape over the feed is then not asked for.
Neighbours neighbours(const std::vector<RecordedStretch>& stretches, const RecordedStretch& cut, bool same_feed) {
    Neighbours found;
    for (const RecordedStretch& air : stretches) {
        const bool feed_fits = !same_feed || std::abs(air.feed_mm_s - cut.feed_mm_s) < 0.1 * std::abs(cut.feed_mm_s);
        if (!is_air_for(air, cut) || !feed_fits) {
            continue;
        }
        if (air.middle_s < cut.middle_s && (found.before == nullptr || air.middle_s > found.before->middle_s)) {
            found.before = &air;
        }
        if (air.middle_s >= cut.middle_s && (found.after == nullptr || air.middle_s < found.after->middle_s)) {
            found.after = &air;
        }
    }
    found.before = found.before == nullptr ? found.after : found.before;
    found.after = found.after == nullptr ? found.before : found.after;
    return found;
}

}  // namespace

double signed_friction_current_A(const MachineParameters& machine, std::size_t axis, double feed_m_per_min) {
    const auto& drive = machine.axes[axis];
    const auto& slope = feed_m_per_min > 0.0 ? drive.positive : drive.negative;
    const double speed = std::abs(feed_m_per_min);
    const double size = static_cast<double>(slope.at(static_cast<float>(speed))) + static_cast<double>(drive.K_x3_A);
    return std::copysign(size, feed_m_per_min);
}

void refuse_below_velocity_floor(const RecordedStretch& stretch, const MachineParameters& machine) {
    const double floor = static_cast<double>(machine.axes[stretch.axis].velocity_floor_mm_s);
    if (std::abs(stretch.feed_mm_s) < floor) {
        throw InputError(
            fmt::format("{}: {} feeds at {:.3g} mm/s: friction and K_x5/w are undefined near rest; expected at "
                        "least {}.velocity_floor_mm_s = {:g}",
                        stretch.conditions.place, axes[stretch.axis], stretch.feed_mm_s, axes[stretch.axis], floor));
    }
}

double spindle_gain_Nm_per_A(const MachineParameters& machine, double spindle_rad_s) {
    const double base = static_cast<double>(machine.spindle.base_speed_rad_s);
    const double gain = static_cast<double>(machine.spindle.K_t1_Nm_per_A);
    return base > 0.0 && spindle_rad_s > base ? gain * base / spindle_rad_s : gain;
}

AirBaseline air_baseline(const std::vector<RecordedStretch>& stretches, const RecordedStretch& cut,
                         const MachineParameters& machine) {
    const Neighbours any = neighbours(stretches, cut, false);
    if (any.before == nullptr) {
        throw InputError(
            fmt::format("{}: the idle torque cannot be separated from the cut's: no row in air with the feed in "
                        "{}{}; expected one before or after the cut (axial_depth_mm 0)",
                        cut.conditions.place, cut.feed_mm_s > 0.0 ? '+' : '-', axes[cut.axis]));
    }
    const Neighbours same_feed = neighbours(stretches, cut, true);
    const Neighbours& for_friction = same_feed.before != nullptr ? same_feed : any;
    const auto scale = [&](const RecordedStretch& air) { return friction_scale_in_air(air, machine); };
    return {any.at(cut.middle_s, [](const RecordedStretch& air) { return air.spindle_current_A; }),
            for_friction.at(cut.middle_s, scale)};
}

estimation::DriveGainDoubt gain_doubt(const MachineParameters& machine, std::size_t axis) {
    const double spindle = static_cast<double>(machine.spindle.gain_relative_sd);
    const double feed = static_cast<double>(machine.axes[axis].gain_relative_sd);
    const double shared = std::min(spindle, feed);
    return {std::sqrt(spindle * spindle - shared * shared), std::sqrt(feed * feed - shared * shared), shared};
}

std::vector<CutRow> forces_of_cuts(const std::vector<RecordedStretch>& stretches, const MachineParameters& machine) {
    std::vector<CutRow> cuts;
    for (const RecordedStretch& stretch : stretches) {
        refuse_below_velocity_floor(stretch, machine);
        if (!stretch.conditions.in_cut()) {
            continue;
        }
        const auto& axis = machine.axes[stretch.axis];
        const double gain = static_cast<double>(axis.K_x4_N_per_A);
        if (!(gain > 0.0)) {
            throw InputError(
                fmt::format("{}: {} feeds, and the machine has no {}.K_x4_N_per_A; expected it from "
                            "'millforce calibrate standard-cut'",
                            stretch.conditions.place, axes[stretch.axis], axes[stretch.axis]));
        }
        const AirBaseline air = air_baseline(stretches, stretch, machine);
        const double w = stretch.feed_m_per_min();
        const double friction_A = air.friction_scale * signed_friction_current_A(machine, stretch.axis, w);
        const double force_N = gain * (stretch.axis_current_A - static_cast<double>(axis.gravity_A) - friction_A) +
                               static_cast<double>(axis.K_x5_N_m_per_min) / w;
        CutRow row;
        row.tool_diameter_mm = stretch.conditions.tool_diameter_mm;
        row.flutes = stretch.conditions.flutes;
        row.spindle_rad_s = stretch.spindle_rad_s;
        row.axial_depth_mm = stretch.conditions.axial_depth_mm;
        row.radial_width_mm = stretch.conditions.radial_width_mm;
        row.feed_mm_s = std::abs(stretch.feed_mm_s);
        row.spindle_torque_Nm =
            spindle_gain_Nm_per_A(machine, stretch.spindle_rad_s) * (stretch.spindle_current_A - air.idle_current_A);
        row.feed_force_N = stretch.feed_mm_s > 0.0 ? force_N : -force_N;
        cuts.push_back(row);
    }
    return cuts;
}

}  // namespace millforce::host
