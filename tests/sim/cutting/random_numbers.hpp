// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <random>

namespace millforce::sim {

/// A seeded source whose numbers are the same on every platform (the distributions of <random> are not).
class RandomNumbers {
  public:
    explicit RandomNumbers(unsigned seed) : engine_(seed) {}

    double between(double low, double high) {
        constexpr double range = 4294967296.0;
        return low + (high - low) * (static_cast<double>(engine_()) / range);
    }

    std::size_t whole(std::size_t low, std::size_t high) {
        return low + static_cast<std::size_t>(engine_()) % (high - low + 1);
    }

  private:
    std::mt19937 engine_;
};

}  // namespace millforce::sim
