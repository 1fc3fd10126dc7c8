// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

/// The minimum of a function of one variable, for fits that are linear but for one parameter.

namespace millforce::estimation {

/// Where `misfit` is least between `low` and `high`: a scan in `steps` equal steps, then a golden-section search
/// between the neighbours of the best point. The scan is there because the misfit may have several minima; it must be
/// fine enough to hit the lowest one. The place is found to 1e-8 of a step.
[[nodiscard]] double place_of_minimum(const std::function<double(double)>& misfit, double low, double high, int steps);

}  // namespace millforce::estimation
