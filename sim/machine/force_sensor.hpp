// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "machine/butterworth.hpp"

namespace millforce::sim {

/// A dynamometer with its charge amplifier and converter. The noise is white before the filter, so that it comes out in
/// the filter's band with the stated deviation: vibration and the amplifier.
struct ForceSensorSettings {
    double low_pass_hz = 0.0;  ///< Butterworth, second order; 0: no sensor
    double noise_N = 10.0;
    double zero_drift_N = 2.0;  ///< deviation of what the amplifier drifted since its zeroing in air
    double resolution_N = 1.0;  ///< that of a 12-bit converter over ± 2 kN

    [[nodiscard]] bool is_there() const { return low_pass_hz > 0.0; }
};

/// One of its forces, stepped at a fixed rate above twice the corner.
class ForceChannel {
  public:
    ForceChannel(const ForceSensorSettings& settings, double rate_hz, std::uint64_t seed)
        : resolution_N_(settings.resolution_N), filter_(settings.low_pass_hz, rate_hz), random_(seed) {
        // Noise bandwidth of the Butterworth filter: 1.11 of its corner.
        white_N_ = settings.noise_N * std::sqrt(0.5 * rate_hz / (1.1107 * settings.low_pass_hz));
        zero_N_ = settings.zero_drift_N * normal_(random_);
    }
    double step(double force_N) {
        filtered_N_ = filter_.filter(force_N + white_N_ * normal_(random_));
        return filtered_N_;
    }
    /// The converter's value after the last step.
    [[nodiscard]] double reading_N() const {
        const double in_N = filtered_N_ + zero_N_;
        return resolution_N_ > 0.0 ? std::round(in_N / resolution_N_) * resolution_N_ : in_N;
    }

  private:
    double resolution_N_;
    ButterworthFilter filter_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
    double white_N_ = 0.0;
    double zero_N_ = 0.0;
    double filtered_N_ = 0.0;
};

}  // namespace millforce::sim
