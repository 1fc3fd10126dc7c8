// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace millforce::sim {

/// Butterworth low-pass of second order, as a charge amplifier has one: by the bilinear transform with the corner kept.
/// 0 < corner_hz < rate_hz/2. Starts at rest at 0.
class ButterworthFilter {
  public:
    ButterworthFilter(double corner_hz, double rate_hz) {
        const double k = std::tan(std::numbers::pi * corner_hz / rate_hz);
        const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
        forward_ = k * k * norm;
        back_1_ = 2.0 * (k * k - 1.0) * norm;
        back_2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
    }
    double filter(double in) {
        const double out = forward_ * in + state_1_;
        state_1_ = 2.0 * forward_ * in - back_1_ * out + state_2_;
        state_2_ = forward_ * in - back_2_ * out;
        return out;
    }

  private:
    double forward_;
    double back_1_;
    double back_2_;
    double state_1_ = 0.0;
    double state_2_ = 0.0;
};

}  // namespace millforce::sim
