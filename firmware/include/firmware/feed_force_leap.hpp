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
    void restart() { *this = FeedForceLeap(); }

    /// Each revolution at a steady velocity. `hidden_N`: the inertia of an acceleration that a steady feed may hide.
    [[nodiscard]] bool follow(const estimation::CutEstimate<Scalar>& e, Scalar teeth, Scalar per_radius,
                              Scalar hidden_N) {
        if (!e.feed_N.valid || !e.tangential_N.valid) {
            restart();
            return false;
        }
        const Revolution now{e.feed_N.value, e.tangential_N.value};
        const bool is_leap = revolutions_ == history && leaps(e, now, teeth * per_radius, hidden_N);
        last_but_one_ = last_;
        last_ = now;
        revolutions_ = revolutions_ < history ? revolutions_ + 1 : history;
        const bool is_sure = is_leap && has_leapt_;
        has_leapt_ = is_leap;
        return is_sure;
    }

  private:
    static constexpr int history = 2;
    struct Revolution {
        Scalar feed_N{0};
        Scalar tangential_N{0};
    };

    [[nodiscard]] bool leaps(const estimation::CutEstimate<Scalar>& e, const Revolution& now, Scalar teeth_per_radius,
                             Scalar hidden_N) const {
        using estimation::square;
        constexpr Scalar axes_per_tangential{2};
        constexpr Scalar revolutions{3};
        constexpr Scalar both_ends{3};
        constexpr Scalar significance{5};
        const Scalar leap_N = magnitude(now.feed_N - last_but_one_.feed_N);
        const Scalar change_N = magnitude(now.tangential_N - last_but_one_.tangential_N);
        const Scalar cut_N = magnitude(now.tangential_N);
        const Scalar travel_in_radii = revolutions * e.feed_per_tooth_mm * teeth_per_radius;
        const Scalar excess_N =
            leap_N - axes_per_tangential * change_N - both_ends * travel_in_radii * cut_N - hidden_N;
        const Scalar variance_N2 = e.feed_N.noise + e.feed_N.noise;
        return excess_N > Scalar(0) && square(excess_N) > square(significance) * variance_N2;
    }
    [[nodiscard]] static Scalar magnitude(Scalar value) { return value < Scalar(0) ? -value : value; }

    Revolution last_{};
    Revolution last_but_one_{};
    int revolutions_ = 0;
    bool has_leapt_ = false;
};

}  // namespace millforce::firmware
