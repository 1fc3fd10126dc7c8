// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "report/run_result.hpp"

namespace millforce::sim {

/// What a controlled run promises. A run that breaks it ends the program with exit code 1.
inline constexpr double largest_peak_over_limit = 1.10;

/// The program came to its end, no tooth broke, no peak went beyond the bound, and none above the limit came later than
/// the reaction time after the engagement grew.
inline bool bounds_hold(const RunFigures& figures) {
    return figures.finished && figures.teeth_broken == 0 && figures.peak_over_limit <= largest_peak_over_limit &&
           !(figures.late_over_limit_s > 0.0);
}

}  // namespace millforce::sim
