// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "estimation/cut_estimate.hpp"
#include "estimation/number/literal.hpp"
#include "firmware/steady_cut.hpp"

namespace millforce::firmware {

/// The tooth force of a cut whose width is not known, while the spindle's force falls and that of the axes stays.
///
/// Without a width the tooth force is only bounded, by F_at, and a spindle current that fades lowers the bound. A cut
/// that becomes lighter lowers the force along the feed, too. Where F_at falls alone, the cut may be as it was:
///
///   s = (F_at/√f)/(F_at/√f)₀,    a = ((|F_ax| − σ)/√f)/((|F_ax| − σ)/√f)₀    σ: standard deviation, of friction mostly
///   F_tooth ≥ (F_tooth/√f)₀ √f min(a, 1)    where s < min(a, 1) − 5 %
///
/// All are means of some 16 estimates. A force grows with the feed f by a power between 0 and 0.8, by 1/2 roughly. ₀:
/// when the width was last known, else where F_at/√f was largest since both forces last changed by a quarter at once,
/// with the smallest F_tooth/√f per a before F_at fell alone.
///
/// A wall that converges may lower F_at alone as well: then the bound stays higher than it need be. Doubt outlasts the
/// cut, until re-zeroing in air finds the currents as they should be. Where the width is known: steady_cut.hpp. Where
/// no force along the feed is: slow_fall.hpp.
///
/// Cost: some 30 operations, a square root and two divisions an estimate. No heap. One thread.
template <typename Scalar>
class LoneFall {
  public:
    using Estimate = estimation::CutEstimate<Scalar>;

    /// The tool is out of the cut.
    void leave_cut() { estimates_ = has_fallen_ ? estimates_ : std::uint8_t{0}; }
    /// Re-zeroing in air has found the currents to be as they should.
    void clear() { *this = LoneFall(); }

    /// Along the feed there is surely still half the force of the last cut: the spindle's has fallen alone.
    [[nodiscard]] bool axes_still_cut(const Estimate& e, Scalar per_root_feed) const {
        using std::sqrt;
        constexpr Scalar surely = Scalar(3);
        const Scalar least_N = size(e.feed_N.value) - surely * sqrt(e.feed_N.variance);
        return e.feed_N.valid && mean_.axes > Scalar(0) && least_N * per_root_feed > estimation::halved(mean_.axes);
    }

    /// The tooth force that a new estimate leaves possible, not below the `tooth_force_N` by its own account.
    /// `per_root_feed`: 1/√f, 0 without a feed. `follows`: the cut neither begins nor ends.
    [[nodiscard]] Scalar largest_force_N(const Estimate& e, Scalar tooth_force_N, Scalar per_root_feed, bool follows) {
        const Scalar axes_N = by_axes_N(e);
        if (!e.tangential_N.valid || !(e.tangential_N.value > Scalar(0)) || !(axes_N > Scalar(0)) ||
            !(per_root_feed > Scalar(0))) {
            return tooth_force_N;
        }
        const Forces now{e.tangential_N.value * per_root_feed, axes_N * per_root_feed, tooth_force_N * per_root_feed};
        if (follows && e.tooth_force_N.valid) {
            follow(now, is_width_known(e.engagement) && !e.tooth_force_is_bound);
        }
        const Scalar root_feed = e.feed_per_tooth_mm * per_root_feed;
        const Scalar possible_N = has_fallen_ ? first_.tooth * share_of_axes(now) * root_feed : Scalar(0);
        return possible_N > tooth_force_N ? possible_N : tooth_force_N;
    }

  private:
    /// Divided by √f.
    struct Forces {
        Scalar spindle{0};
        Scalar axes{0};
        Scalar tooth{0};
    };

    [[nodiscard]] static Scalar size(Scalar force) { return force < Scalar(0) ? -force : force; }

    /// What is surely more than a wrong friction: so a cut that becomes lighter never seems to do so by the spindle
    /// alone.
    [[nodiscard]] static Scalar by_axes_N(const Estimate& e) {
        using std::sqrt;
        return e.feed_N.valid ? size(e.feed_N.value) - sqrt(e.feed_N.variance) : Scalar(0);
    }

    [[nodiscard]] static bool is_step(Scalar now, Scalar mean) { return size(now - mean) > Scalar(0.25F) * mean; }

    [[nodiscard]] Scalar share_of_axes(const Forces& forces) const {
        return forces.axes < first_.axes ? forces.axes / first_.axes : Scalar(1);
    }

    void follow(const Forces& now, bool width_is_known) {
        constexpr Scalar share{0.0625F};
        if (is_step(now.spindle, mean_.spindle) && is_step(now.axes, mean_.axes)) {
            clear();
            mean_ = now;
        }
        mean_.spindle += (now.spindle - mean_.spindle) * share;
        mean_.axes += (now.axes - mean_.axes) * share;
        mean_.tooth += (now.tooth - mean_.tooth) * share;
        if (estimates_ < settled) {
            ++estimates_;
            first_ = mean_;
        } else {
            compare(width_is_known);
        }
    }

    void compare(bool width_is_known) {
        constexpr Scalar least_share = estimation::literal<Scalar>(0.05L);
        if ((width_is_known && !has_fallen_) || mean_.spindle > first_.spindle) {
            has_fallen_ = false;
            first_ = mean_;
            return;
        }
        const Scalar axes = share_of_axes(mean_);
        has_fallen_ = mean_.spindle < (axes - least_share) * first_.spindle;
        if (!has_fallen_ && mean_.tooth < axes * first_.tooth) {
            first_.tooth = mean_.tooth / axes;
        }
    }

    static constexpr std::uint8_t settled = 64;  // estimates until the mean has forgotten how it began

    std::uint8_t estimates_ = 0;  // since the last step, up to `settled`
    bool has_fallen_ = false;     // alone
    Forces mean_{};
    Forces first_{};  // ₀
};

}  // namespace millforce::firmware
