// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "reproduce/hwang_runs.hpp"

/// The constants of Hwang et al.'s equations, from cuts of known immersion on the bench.

namespace millforce::sim {

inline constexpr std::uint64_t hwang_seed = 1;

/// The laws that the estimators use: with the edge forces taken out, and as the paper has it, without.
struct HwangLaws {
    std::vector<estimation::ForceDropCalibrationCut> steel_cuts;
    estimation::ForceDropCalibration::Result steel{};
    estimation::ForceDropCalibration::Result aluminium{};
    estimation::ForceDropCalibration::Result steel_down{};
    estimation::ForceDropCalibration::Result steel_without_edges{};
    estimation::ForceDropCalibration::Result aluminium_without_edges{};

    /// a of Eq. 12, edge force left in, of the same steel with other edge forces: the paper prints none.
    double a_at_twice_K_te_without_size_effect = 0.0;
    double a_at_twice_both_edge_forces = 0.0;
};

[[nodiscard]] HwangLaws calibrated_laws();

/// A point of Fig. 7: both force ratios of one cut of known immersion, edge forces left in.
struct ForceRatioPoint {
    double r_av = 0.0;
    double r = 0.0;
};
[[nodiscard]] std::vector<ForceRatioPoint> force_ratio_points(
    const std::vector<estimation::ForceDropCalibrationCut>& cuts);

}  // namespace millforce::sim
