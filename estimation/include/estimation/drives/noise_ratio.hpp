// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

namespace millforce::estimation {

/// How noisy a motor's current is: the variance of its noise over what current_sd_A says, ≥ 1.
///
/// In air, at an unchanged feed and speed, a tooth period's mean differs from that of the same tooth one revolution
/// before by noise alone:
///
///   q ← q + (min(Δ²/σ²(Δ), 9) max(q, 1) − q)/n,   n = 9 … 64          σ²(Δ): by max(q, 1) and current_sd_A
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
        ratio_ += (seen * value() - ratio_) / weight_;
        if (first_decided <= weight_ && weight_ <= last_decided) {
            is_as_stated_ = is_as_stated_ || ratio_ > least_as_stated;
        }
    }

    /// As much noise as stated, or more, by the first 8 to 24 differences: a current that shows too little of all shows
    /// too little noise. A sound one passes for weak in one of 500 cases, one at a third of its gain always, one at
    /// half in two of three. Not decided later, since what is learnt then may be a cut that a weak signal hides.
    [[nodiscard]] bool is_as_stated() const { return is_as_stated_; }

    [[nodiscard]] Scalar value() const { return ratio_ > Scalar(1) ? ratio_ : Scalar(1); }

  private:
    static constexpr Scalar longest{64};
    static constexpr Scalar first_decided{16};
    static constexpr Scalar last_decided{32};
    static constexpr Scalar least_as_stated = literal<Scalar>(0.65L);  // a share of it is the 1 that it begins with

    Scalar ratio_{1};
    Scalar weight_{8};
    bool is_as_stated_ = false;
};

}  // namespace millforce::estimation
