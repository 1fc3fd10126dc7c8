// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// Whether the force along the feed leaps while F_at does not: an axis' current is wrong from then on.
///
/// Where one end of the arc moves, or the feed changes, the axes' force changes by at most twice as much as F_at, since
/// no tooth's radial force is more than √3 times its tangential one. Both ends may move at once so that F_at stays:
/// within s of travel each by some 1.5 s/R at most. So from one revolution to the next but one the force along the feed
/// changes by no more than
///
///     2 |ΔF_at| + 3 (s/R) F_at + 5 σ,   s: the travel of the three revolutions
///
/// and what a feed that seems steady may hide of the axis' inertia. Twice in a row: a caught chip is no leap. Unlike a
/// change from tooth to tooth, this is seen while a cut begins as well, and in a light cut whose noise is large.
///
/// Not judged: a force along the feed that is not known, as where an axis turns round. The history begins anew there;
/// so it must by restart() where the velocity changes.
///
/// Cost: some 60 instructions a revolution. No heap, no clock. One thread.
template <typename Scalar>
class FeedForceLeap {
  public:
    /// `hidden_inertia`: N per mm/s of feed and rad/s of the spindle that an acceleration may hide at a steady feed.
    FeedForceLeap(Scalar teeth, Scalar per_radius, Scalar hidden_inertia)
        : share_per_feed_(Scalar(both_ends * revolutions) * teeth * per_radius), hidden_inertia_(hidden_inertia) {}

    void restart() {
        known_ = 0;
        has_leapt_ = false;
    }

    /// Each revolution at a steady velocity.
    [[nodiscard]] bool follow(const estimation::CutEstimate<Scalar>& e) {
        if (!e.feed_N.valid || !e.tangential_N.valid) {
            restart();
            return false;
        }
        const Revolution now{e.feed_N.value, e.tangential_N.value};
        const bool leaps = known_ == history && is_leap(e, now);
        last_but_one_ = last_;
        last_ = now;
        known_ = known_ < history ? known_ + 1 : history;
        const bool is_sure = leaps && has_leapt_;
        has_leapt_ = leaps;
        return is_sure;
    }

  private:
    static constexpr int history = 2;
    static constexpr int revolutions = 3;
    static constexpr int both_ends = 3;
    struct Revolution {
        Scalar feed_N{0};
        Scalar tangential_N{0};
    };

    /// What costs least comes first.
    [[nodiscard]] bool is_leap(const estimation::CutEstimate<Scalar>& e, const Revolution& now) const {
        using estimation::square;
        constexpr Scalar significance{5};
        const Scalar leap_N = magnitude(now.feed_N - last_but_one_.feed_N);
        const Scalar change_N = magnitude(now.tangential_N - last_but_one_.tangential_N);
        const Scalar beyond_change_N = leap_N - change_N - change_N;
        if (!(beyond_change_N > Scalar(0))) {
            return false;
        }
        const Scalar by_both_ends_N = share_per_feed_ * e.feed_per_tooth_mm * magnitude(now.tangential_N);
        const Scalar hidden_N = hidden_inertia_ * e.feed_mm_s * e.spindle_speed_rad_s;
        const Scalar excess_N = beyond_change_N - by_both_ends_N - hidden_N;
        const Scalar variance_N2 = e.feed_N.noise + e.feed_N.noise;
        return excess_N > Scalar(0) && square(excess_N) > square(significance) * variance_N2;
    }
    [[nodiscard]] static Scalar magnitude(Scalar value) { return value < Scalar(0) ? -value : value; }

    Scalar share_per_feed_;  // 1/mm
    Scalar hidden_inertia_;
    Revolution last_{};
    Revolution last_but_one_{};
    int known_ = 0;
    bool has_leapt_ = false;
};

}  // namespace millforce::firmware
