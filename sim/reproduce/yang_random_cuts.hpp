// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Cuts drawn at random over all twelve categories, up and down, estimated by the profile fit.

namespace millforce::sim::yang {

struct RandomCutOptions {
    std::size_t count = 1000;
    double largest_runout_in_feeds = 0.15;
    bool tip_angle_known = true;  ///< learnt from a cut of nominal depths, of another hardness
    std::uint64_t seed = 20;
};

struct RandomCutOutcome {
    double axial_error_percent;  ///< share of the nominal depth; NaN: no estimate
    double radial_error_percent;
    double axial_error_in_sd;
    double radial_error_in_sd;
    bool up_milling;
    std::size_t category;  ///< 4 × type + overlap, of the true depths
};

[[nodiscard]] std::vector<RandomCutOutcome> random_cuts(const RandomCutOptions& options);

/// Statistics of the outcomes. A cut's error is the larger of its two; a cut without estimate counts as infinitely
/// wrong in the percentile, and is left out of mean and coverage.
struct RandomCutSummary {
    double mean_error_percent;  ///< over both depths of the cuts with estimate
    double percentile_95_percent;
    double percentile_95_up_percent;
    double percentile_95_down_percent;
    double answered_share;
    double largest_answered_percent;  ///< the largest error that came as an estimate
    double within_two_sd_share;
    std::size_t categories;  ///< number of the twelve that occur
};

[[nodiscard]] RandomCutSummary summary_of(const std::vector<RandomCutOutcome>& outcomes);

}  // namespace millforce::sim::yang
