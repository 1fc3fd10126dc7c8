// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/force_drop/force_drop.hpp"
#include "estimation/number/literal.hpp"
#include "firmware/parameters.hpp"

/// Settings of the wide-band methods, worked out from the parameters.

namespace millforce::firmware {

/// The tool's file holds a calibrated law.
template <typename Scalar>
bool has_force_drop_law(const ToolParameters<Scalar>& tool) {
    return tool.force_drop.law.largest_immersion > Scalar(0);
}

/// The tool's file gives both nominal depths, and the force of such a cut has a shape: a helix, a wall to one side.
template <typename Scalar>
bool has_nominal_depths(const ToolParameters<Scalar>& tool) {
    const DepthShapeParameters<Scalar>& shape = tool.depth_shape;
    return shape.nominal_axial_depth_mm > Scalar(0) && shape.nominal_radial_width_mm > Scalar(0);
}
template <typename Scalar>
bool force_has_shape(const ToolParameters<Scalar>& tool) {
    return !(tool.helix_deg < Scalar(5)) && tool.side != estimation::CutSide::centred;
}

template <typename Scalar>
bool has_force_sensor(const ToolParameters<Scalar>& tool) {
    return tool.force_sensor.low_pass_hz > Scalar(0);
}

template <typename Scalar>
estimation::ForceDropLaw<Scalar> force_drop_law(const ToolParameters<Scalar>& tool) {
    estimation::ForceDropLaw<Scalar> law = tool.force_drop.law;
    law.valid = true;
    // The parameters hold the upper triangles.
    law.a_b_covariance(1, 0) = law.a_b_covariance(0, 1);
    law.c_covariance(1, 0) = law.c_covariance(0, 1);
    law.c_covariance(2, 0) = law.c_covariance(0, 2);
    law.c_covariance(2, 1) = law.c_covariance(1, 2);
    return law;
}

/// Feed drives: the observer's own low-pass (FeedForceObserver), and the friction that no air gap shows.
template <typename Scalar>
estimation::ForceDropSettings<Scalar> force_drop_settings(const Parameters<Scalar>& p) {
    estimation::ForceDropSettings<Scalar> settings;
    settings.detector.teeth = p.tool.teeth;
    settings.revolutions = p.tool.force_drop.revolutions;
    settings.side = p.tool.side;
    if (has_force_sensor(p.tool)) {
        settings.detector.response.corner_hz = p.tool.force_sensor.low_pass_hz;
        settings.zero_drift_sd_N = p.tool.force_sensor.zero_drift_sd_N;
    } else {
        settings.detector.response.corner_hz = estimation::literal<Scalar>(0.22L) * p.machine.cnc.sample_rate_hz;
        for (std::size_t k = 0; k < 2; ++k) {
            const Scalar ripple_N = p.machine.axes[k].K_x4_N_per_A * p.machine.axes[k].friction_ripple_A;
            settings.mean_force_sd_N = ripple_N > settings.mean_force_sd_N ? ripple_N : settings.mean_force_sd_N;
        }
    }
    return settings;
}

/// Depths to 55 % on either side of the nominal one, so that a variation of 50 % is not at the end of the search.
template <typename Scalar>
estimation::DepthRange<Scalar> depth_range_about(Scalar nominal_mm, Scalar largest_mm) {
    constexpr Scalar reach = estimation::literal<Scalar>(0.55L);
    const Scalar high_mm = (Scalar(1) + reach) * nominal_mm;
    return {(Scalar(1) - reach) * nominal_mm, high_mm < largest_mm ? high_mm : largest_mm};
}

template <typename Scalar>
estimation::FluteProfileFitSettings<Scalar> depth_shape_settings(const ToolParameters<Scalar>& tool) {
    constexpr Scalar degree_rad = estimation::pi<Scalar> / Scalar(180);
    const DepthShapeParameters<Scalar>& shape = tool.depth_shape;
    estimation::FluteProfileFitSettings<Scalar> settings;
    settings.cutter = {tool.teeth, Scalar(0.5F) * tool.diameter_mm, tool.helix_deg * degree_rad};
    settings.feed_per_tooth_mm = shape.feed_per_tooth_mm;
    settings.side = tool.side;
    settings.axial = depth_range_about(shape.nominal_axial_depth_mm, tool.flute_length_mm);
    settings.radial = depth_range_about(shape.nominal_radial_width_mm, tool.diameter_mm);
    if (has_force_sensor(tool)) {
        settings.low_pass = {2, tool.force_sensor.low_pass_hz};
    }
    const Scalar sd_rad = shape.tip_angle_sd_deg * degree_rad;
    settings.tip_angle_rad = {sd_rad > Scalar(0), shape.tip_angle_deg * degree_rad, sd_rad * sd_rad, sd_rad * sd_rad};
    return settings;
}

}  // namespace millforce::firmware
