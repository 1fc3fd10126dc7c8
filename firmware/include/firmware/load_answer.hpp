// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/number/literal.hpp"
#include "firmware/parameters.hpp"

namespace millforce::firmware {

/// Whether the spindle's load, where a converter tells it seldom, still answers the feed.
///
/// Ten readings a second, rounded, may rightly be the same for seconds: their number shows no load that stands still.
/// But in a cut that stays the same F_at follows the feed f, to first order by
///
///     ΔF = F_at c (1+p_s) Δf/f            c: share of F_at that is not edge force
///
/// and a reading must change where ΔF exceeds A = q + 2 sd, as a force. q: the smallest step that was seen, which
/// rounding makes no smaller.
///
///   bound   until there is another reading, the feed rises by no more than ΔF = A beyond the one that it came at
///   asked   a reading has stood for 2 s: the bound falls, by a quarter of the feed each second and to ΔF = −2.5 A,
///           until there is another reading
///   dead    asked, and the feed has settled (settled_feed.hpp) below ΔF = −2 A: no other reading
///
/// The law, too, lowers the feed of a cut that becomes heavier such that the load stays as it is, but more slowly: that
/// alone says nothing, and what fell before the question does not count.
///
/// Not asked: a cut so light that half the feed would not show, and a load whose steps are not known yet. A load that
/// stands still in air is not seen.
///
/// Cost: some 20 operations and two divisions an estimate where the load comes seldom, else none. No heap. One thread.
template <typename Scalar>
class LoadAnswer {
  public:
    /// Of A/F_at c (1+p_s): a load that is asked can still show it.
    static constexpr Scalar largest_answer = estimation::literal<Scalar>(0.24L);

    explicit LoadAnswer(const Parameters<Scalar>& p)
        : N_per_A_(p.tool.diameter_mm > Scalar(0) ? p.machine.spindle.K_t1_Nm_per_A * Scalar(2000) / p.tool.diameter_mm
                                                  : Scalar(0)),
          sd_A_(p.machine.spindle.current_sd_A),
          comes_seldom_(p.machine.spindle_load_period_s > Scalar(0)) {}

    /// Each sample's spindle current.
    void take(Scalar current_A) { told_A_ = current_A; }
    /// Out of the cut, or another reading: nothing is expected.
    void restart() {
        feed_mm_s_ = since_s_ = asked_ = Scalar(0);
        is_dead_ = false;
    }
    /// A new estimate in the cut. `period_s`: of a tooth.
    void follow(const estimation::CutEstimate<Scalar>& e, Scalar period_s, bool feed_is_settled) {
        if (!comes_seldom_) {
            return;
        }
        since_s_ += period_s * Scalar(e.tooth_periods);
        take_reading();
        answer_ = answer_share(e);
        if (feed_is_settled && !(feed_mm_s_ > Scalar(0))) {
            feed_mm_s_ = e.feed_mm_s;
        }
        if (asked_ > Scalar(0)) {
            is_dead_ = feed_is_settled && e.feed_mm_s < feed_mm_s_ * (Scalar(1) - asked_ - asked_);
        } else if (since_s_ > patience_s && answer_ > Scalar(0) && answer_ < largest_answer) {
            asked_ = answer_;
            feed_mm_s_ = e.feed_mm_s;
            since_s_ = Scalar(0);
        }
    }

    /// 0: none.
    [[nodiscard]] Scalar bound_mm_s() const {
        constexpr Scalar fall_per_s = Scalar(0.25F);
        constexpr Scalar deepest = Scalar(2.5F);  // of A
        if (!(answer_ > Scalar(0))) {
            return Scalar(0);
        }
        const Scalar fall = fall_per_s * since_s_;
        const Scalar asked = fall < deepest * asked_ ? fall : deepest * asked_;
        return feed_mm_s_ * (Scalar(1) + (asked_ > Scalar(0) ? -asked : answer_));
    }
    [[nodiscard]] bool is_dead() const { return is_dead_; }

  private:
    static constexpr Scalar patience_s = Scalar(2);

    void take_reading() {
        const Scalar step_A = told_A_ < known_A_ ? known_A_ - told_A_ : told_A_ - known_A_;
        if (!(step_A > Scalar(0))) {
            return;
        }
        const bool is_finer = !(smallest_step_A_ > Scalar(0)) || step_A < smallest_step_A_;
        smallest_step_A_ = has_reading_ && is_finer ? step_A : smallest_step_A_;
        has_reading_ = true;
        known_A_ = told_A_;
        restart();
    }
    /// A as a share of the feed; 0: not known.
    [[nodiscard]] Scalar answer_share(const estimation::CutEstimate<Scalar>& e) const {
        const Scalar by_feed_N = e.tangential_N.value * e.cutting_share * e.feed_exponent;
        return smallest_step_A_ > Scalar(0) && by_feed_N > Scalar(1)
                   ? N_per_A_ * (smallest_step_A_ + sd_A_ + sd_A_) / by_feed_N
                   : Scalar(0);
    }

    Scalar N_per_A_;  // of the spindle's current, at the cutter's radius
    Scalar sd_A_;
    bool comes_seldom_;
    bool has_reading_ = false;
    bool is_dead_ = false;
    Scalar told_A_{0};
    Scalar known_A_{0};          // the reading of the last estimate
    Scalar smallest_step_A_{0};  // 0: none was seen
    Scalar feed_mm_s_{0};        // settled, of this reading, or that of the question; 0: not settled yet
    Scalar since_s_{0};          // the reading, or the question
    Scalar answer_{0};           // A, as a share of the feed
    Scalar asked_{0};            // A when the question began; 0: not asked
};

}  // namespace millforce::firmware
