// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

namespace millforce::sim {

/// Uniform from `low` to below `high`. Not std::uniform_real_distribution: its numbers differ between libraries.
[[nodiscard]] inline double drawn_within(double low, double high, std::mt19937_64& random) {
    return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

}  // namespace millforce::sim
