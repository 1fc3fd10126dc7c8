// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

namespace millforce::estimation {

/// How noisy a motor's current is: the variance of its noise over what current_sd_A says, ≥ 1.
///
/// In air, at an unchanged feed and speed, a tooth period's mean differs from that of the same tooth one revolution
/// before by noise alone:
///
///   q ← q + (min(Δ²/σ²(Δ), 9) q − q)/n,   n = 9 … 64          σ²(Δ): by q and current_sd_A
///
/// It begins at 1, with the weight of eight. Noise that is not white, or held by a slow converter, counts by what it
/// does to the mean of a tooth period. One outlier counts no more than three standard deviations do.
///
/// Cost: some ten operations, one or two divisions. Not thread-safe.
template <typename Scalar>
class NoiseRatio {
  public:
    /// `change_N`: the difference as a force, with the variance that this ratio gives it.
    void learn(const Measurement<Scalar>& change_N) {
        if (!change_N.valid || !(change_N.variance > Scalar(0))) {
            return;
        }
        constexpr Scalar most{9};
        const Scalar size2 = square(change_N.value);
        const Scalar seen = size2 < most * change_N.variance ? size2 / change_N.variance : most;
        weight_ = weight_ < longest ? weight_ + Scalar(1) : weight_;
        ratio_ += (seen - Scalar(1)) * ratio_ / weight_;
    }

    [[nodiscard]] Scalar value() const { return ratio_ > Scalar(1) ? ratio_ : Scalar(1); }

  private:
    static constexpr Scalar longest{64};

    Scalar ratio_{1};
    Scalar weight_{8};
};

}  // namespace millforce::estimation
