// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/wide_band_monitor.hpp"

namespace millforce::firmware {

template <typename Scalar>
WideBandMonitor<Scalar>::WideBandMonitor(const Parameters<Scalar>& p)
    : forces_(p),
      teeth_(Scalar(p.tool.teeth)),
      force_drop_revolutions_(Scalar(p.tool.force_drop.revolutions)),
      depth_revolutions_(Scalar(p.tool.depth_shape.revolutions)) {
    const bool has_sensor = has_force_sensor(p.tool);
    const bool has_drives = p.machine.axes[0].K_x4_N_per_A > Scalar(0) && p.machine.axes[1].K_x4_N_per_A > Scalar(0);
    uses_force_drop_ = has_force_drop_law(p.tool) && (has_sensor || has_drives);
    uses_depths_ = has_nominal_depths(p.tool) && force_has_shape(p.tool) && has_sensor;
    if (uses_force_drop_) {
        force_drop_ = estimation::ForceDrop<Scalar>(force_drop_law(p.tool), force_drop_settings(p));
    }
    if (uses_depths_) {
        depths_ = estimation::DepthMonitor<Scalar>(depth_shape_settings(p.tool), static_cast<int>(depth_revolutions_));
    }
}

template <typename Scalar>
bool WideBandMonitor<Scalar>::add(Scalar dt_s, const hal::DriveSample& sample, bool in_cut) {
    if (!uses_force_drop_ && !uses_depths_) {
        return false;
    }
    const Forces forces = in_cut ? forces_.read(dt_s, sample) : Forces{};
    if (!forces.valid || forces.is_new_frame) {
        restart();
    }
    if (!forces.valid) {
        forces_.restart();
        return false;
    }
    is_clear_ = false;
    follow(dt_s, forces);
    collect(dt_s, forces);
    drop_outdated();
    return uses_force_drop_ && !forces.is_new_frame;
}

template <typename Scalar>
void WideBandMonitor<Scalar>::work() {
    if (force_drop_.complete()) {
        evaluate_force_drop();
    } else if (depths_.complete()) {
        evaluate_depths();
    }
}

template <typename Scalar>
void WideBandMonitor<Scalar>::restart() {
    if (is_clear_) {
        return;
    }
    is_clear_ = true;
    estimate_.force_drop_immersion = {};
    estimate_.axial_depth_mm = {};
    estimate_.radial_width_mm = {};
    force_drop_travel_ = {};
    depth_travel_ = {};
    force_drop_.restart();
    depths_.restart();
}

template <typename Scalar>
void WideBandMonitor<Scalar>::follow(Scalar dt_s, const Forces& forces) {
    if (forces.is_new_frame) {
        return;
    }
    for (Travel* travel : {&force_drop_travel_, &depth_travel_}) {
        travel->path_mm += forces.speed_mm_s * dt_s;
        travel->turned_rev += forces.turned_rev;
    }
}

template <typename Scalar>
void WideBandMonitor<Scalar>::collect(Scalar dt_s, const Forces& forces) {
    const Scalar since_s = forces.is_new_frame ? Scalar(0) : dt_s;
    if (uses_force_drop_) {
        force_drop_.collect({forces.angle_rev, since_s, forces.along_N, forces.across_N});
    }
    if (uses_depths_) {
        depths_.add(since_s, forces.angle_rev * estimation::turn_rad<Scalar>, forces.along_N, forces.across_N);
    }
}

template <typename Scalar>
void WideBandMonitor<Scalar>::evaluate_force_drop() {
    const auto& made = force_drop_.evaluate(force_drop_travel_.feed_per_tooth_mm(teeth_));
    const Scalar variance = estimation::square(made.radial_immersion_sd);
    estimate_.force_drop_immersion = {made.valid(), made.radial_immersion, variance, variance};
    ++estimate_.force_drops;
    estimate_.force_drops_valid += made.valid() ? 1U : 0U;
    using Reason = typename estimation::ForceDropEstimate<Scalar>::Reason;
    estimate_.force_drops_of_another_filter += made.reason == Reason::other_filter ? 1U : 0U;
    force_drop_travel_ = {};
}

template <typename Scalar>
void WideBandMonitor<Scalar>::evaluate_depths() {
    const auto made = depths_.evaluate();
    estimate_.axial_depth_mm = made.axial_depth_mm;
    estimate_.radial_width_mm = made.radial_depth_mm;
    ++estimate_.depths;
    estimate_.depths_valid += made.axial_depth_mm.valid || made.radial_depth_mm.valid ? 1U : 0U;
    depth_travel_ = {};
}

/// An estimate expires if no new one has followed after twice its number of revolutions: samples are missing.
template <typename Scalar>
void WideBandMonitor<Scalar>::drop_outdated() {
    constexpr Scalar late{2};
    if (force_drop_travel_.turned_rev > late * force_drop_revolutions_) {
        estimate_.force_drop_immersion.valid = false;
    }
    if (depth_travel_.turned_rev > late * depth_revolutions_) {
        estimate_.axial_depth_mm.valid = false;
        estimate_.radial_width_mm.valid = false;
    }
}

}  // namespace millforce::firmware
