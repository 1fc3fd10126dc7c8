// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "reproduce/hwang_table.hpp"

/// The threshold of Hwang et al.'s introduction.

namespace millforce::sim {

/// The allowed total force per allowed force on one tooth (the paper's introduction): from the model at the estimated
/// immersion, and from the plant at the true one, without runout.
struct ThresholdPoint {
    double immersion = 0.0;
    double estimated = 0.0;
    double cautious = 0.0;  ///< at two standard deviations below the estimate
    double truth = 0.0;
};

/// One point per cut of a row of Table 1.
[[nodiscard]] std::vector<ThresholdPoint> thresholds(const TableResult& row, const BenchCut& row_cut,
                                                     const estimation::ForceDropCalibration::Result& calibrated);

}  // namespace millforce::sim
