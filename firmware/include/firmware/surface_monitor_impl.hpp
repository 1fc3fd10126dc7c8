// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/surface_monitor.hpp"

#include <cmath>

namespace millforce::firmware {

template <typename Scalar>
SurfaceMonitor<Scalar>::SurfaceMonitor(const ToolParameters<Scalar>& tool)
    : model_(tool.roughness),
      tool_diameter_mm_(tool.diameter_mm),
      declared_depth_mm_(tool.declared_axial_depth_mm),
      Ra_limit_um_(tool.control.Ra_limit_um) {}

template <typename Scalar>
void SurfaceMonitor<Scalar>::update(const estimation::CutEstimate<Scalar>& e) {
    using estimation::square;
    using std::sqrt;
    if (!model_.has_model()) {
        return;
    }
    const Scalar turns_per_s = e.spindle_speed_rad_s * estimation::turns_per_rad<Scalar>;
    const Scalar path_mm_s = sqrt(square(e.feed_mm_s) + square(e.axial_speed_mm_s));
    const Scalar estimated_depth_mm = e.engagement.depth_valid ? e.engagement.axial_depth_mm : Scalar(0);
    const estimation::RoughnessConditions<Scalar> cut{
        Scalar(60) * turns_per_s, turns_per_s > Scalar(0) ? path_mm_s / turns_per_s : Scalar(0), tool_diameter_mm_,
        declared_depth_mm_ > Scalar(0) ? declared_depth_mm_ : estimated_depth_mm, Scalar(1)};
    prediction_ = model_.predict(cut, e.feed_N, e.z_N);
    set_ceiling(e, cut, turns_per_s);
}

template <typename Scalar>
void SurfaceMonitor<Scalar>::set_ceiling(const estimation::CutEstimate<Scalar>& e,
                                         const estimation::RoughnessConditions<Scalar>& cut, Scalar turns_per_s) {
    for_control_ = {};
    const bool is_Ra = model_.model().measure == estimation::RoughnessMeasure::Ra;
    if (!is_Ra || !(Ra_limit_um_ > Scalar(0))) {
        return;
    }
    const auto ceiling = model_.feed_ceiling(cut, e.feed_N, e.z_N, Ra_limit_um_);
    for_control_.valid = ceiling.valid;
    for_control_.in_range = ceiling.in_range;
    // If even the lowest fitted feed is too fast, do not raise a slower feed up to it.
    const bool is_below = !ceiling.reachable && cut[estimation::roughness_feed] < ceiling.feed_mm_rev;
    for_control_.feed_ceiling_mm_s = turns_per_s * (is_below ? cut[estimation::roughness_feed] : ceiling.feed_mm_rev);
}

}  // namespace millforce::firmware
