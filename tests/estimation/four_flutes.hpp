// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/peak_factors.hpp"
#include "estimation/engagement/engagement_solver.hpp"

/// What the estimators know of the tool in these tests: 4 flutes, Ø10 mm, 0.05 mm per tooth.

namespace millforce::tests {

template <typename Scalar>
estimation::CutEstimatorSettings<Scalar> estimator_of_four_flutes() {
    estimation::CutEstimatorSettings<Scalar> settings;
    settings.teeth = Scalar(4);
    settings.cutter_radius_mm = Scalar(5);
    settings.largest_depth_mm = Scalar(10);
    settings.nominal_feed_per_tooth_mm = Scalar(0.05L);
    settings.tooth_force_limit_N = Scalar(1000);
    settings.law_relative_sd = Scalar(0.02L);
    return settings;
}

template <typename Scalar>
estimation::EngagementSolverSettings<Scalar> solver_of_four_flutes() {
    estimation::EngagementSolverSettings<Scalar> settings;
    settings.teeth = Scalar(4);
    settings.law_relative_sd = Scalar(0.02L);
    return settings;
}

template <typename Scalar>
estimation::PeakFactorSettings<Scalar> peaks_of_four_flutes() {
    estimation::PeakFactorSettings<Scalar> settings;
    settings.teeth = Scalar(4);
    settings.cutter_radius_mm = Scalar(5);
    settings.nominal_feed_per_tooth_mm = Scalar(0.05L);
    return settings;
}

}  // namespace millforce::tests
