// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

namespace millforce::sim {

struct SearchRange {
    double low;
    double high;
    double start;
};

struct Minimum {
    std::vector<double> at;
    double value = 0.0;
    int evaluations = 0;
};

/// The simplex method of Nelder and Mead (The Computer Journal 7, 1965, 308–313) within a box: a point outside is moved
/// onto its wall. No derivatives, so that a cost out of noisy runs is allowed. Ends after `evaluations`, or once the
/// simplex is smaller than 0.5 % of the ranges. Deterministic. Needs at least one range.
[[nodiscard]] Minimum minimise(const std::function<double(const std::vector<double>&)>& cost,
                               const std::vector<SearchRange>& ranges, int evaluations);

}  // namespace millforce::sim
