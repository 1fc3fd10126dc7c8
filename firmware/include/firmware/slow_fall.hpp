// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/cut_estimate.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// The force that a slow fall of the spindle's current may hide, on a machine that measures nothing else.
///
/// Within a cut a current that drifts looks like a cut that becomes lighter. No other signal tells them apart, so what
/// falls no faster than a current may drift is not believed:
///
///   H = max(0, H + clamp(m₀ − m, ±d T))    m: mean of F_at/√f over 16 estimates, T: their time, m₀: the mean before,
///   or 0
///
/// A force grows with the feed f by a power between 0 and 0.8, by 1/2 roughly. d: drift of 5 % of rated_current_A per
/// second, as a force. A wall's end, whose force falls faster than that, hides no more than d T. H is 0 again once
/// re-zeroing in air has found the current.
///
/// Cost: one root and one division an estimate. No heap. One thread.
template <typename Scalar>
class SlowFall {
  public:
    explicit SlowFall(Scalar drift_N_per_s) : drift_N_per_s_(drift_N_per_s) {}

    void clear() { *this = SlowFall(drift_N_per_s_); }

    /// A new estimate in a cut that neither begins nor ends. `period_s`: of a tooth.
    void follow(const estimation::CutEstimate<Scalar>& e, Scalar period_s) {
        using std::sqrt;
        if (!is_usable(e)) {
            return;
        }
        const Scalar root = sqrt(e.feed_per_tooth_mm);
        sum_ += e.tangential_N.value / root;
        time_s_ += period_s * Scalar(e.tooth_periods);
        if (++estimates_ < block) {
            return;
        }
        const Scalar mean = sum_ / Scalar(block);
        const Scalar most = drift_N_per_s_ * time_s_ / root;
        const Scalar fall = estimation::clamp(mean_ - mean, -most, most);
        hidden_ = hidden_ + fall > Scalar(0) ? hidden_ + fall : Scalar(0);
        mean_ = mean;
        sum_ = time_s_ = Scalar(0);
        estimates_ = 0;
    }

    /// True force per measured one, ≥ 1, that the drift leaves possible.
    [[nodiscard]] Scalar largest_ratio(const estimation::CutEstimate<Scalar>& e) const {
        using std::sqrt;
        return is_usable(e) ? Scalar(1) + hidden_ * sqrt(e.feed_per_tooth_mm) / e.tangential_N.value : Scalar(1);
    }

  private:
    [[nodiscard]] static bool is_usable(const estimation::CutEstimate<Scalar>& e) {
        constexpr Scalar least_N{1};
        return e.tangential_N.valid && e.tangential_N.value > least_N && e.feed_per_tooth_mm > Scalar(0);
    }

    static constexpr int block = 16;

    Scalar drift_N_per_s_;
    Scalar sum_{0};
    Scalar time_s_{0};
    Scalar mean_{0};
    Scalar hidden_{0};
    int estimates_ = 0;
};

}  // namespace millforce::firmware
