// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/number/literal.hpp"
#include "firmware/drift_doubt.hpp"
#include "firmware/steady_cut_impl.hpp"

namespace millforce::firmware {

/// Per second, as a share of a drive's rated current.
template <typename Scalar>
inline constexpr Scalar largest_drift_share = estimation::literal<Scalar>(0.05L);

/// Of the spindle's current, as a force at the cutter's radius.
template <typename Scalar>
static Scalar spindle_drift_N_per_s(const Parameters<Scalar>& p) {
    constexpr Scalar mm_per_m{1000};
    const Scalar drift_Nm_per_s =
        largest_drift_share<Scalar> * p.machine.spindle_rated_current_A * p.machine.spindle.K_t1_Nm_per_A;
    return p.tool.diameter_mm > Scalar(0) ? drift_Nm_per_s * mm_per_m / estimation::halved(p.tool.diameter_mm)
                                          : Scalar(0);
}

/// Of the axis, x or y, that can drift further. 0 where a rated current of theirs or of the spindle is not stated.
template <typename Scalar>
static Scalar axis_drift_N_per_s(const Parameters<Scalar>& p) {
    const auto of_axis = [&](std::size_t k) {
        return largest_drift_share<Scalar> * p.machine.axis_rated_current_A[k] * p.machine.axes[k].K_x4_N_per_A;
    };
    const Scalar x_N_per_s = of_axis(0);
    const Scalar y_N_per_s = of_axis(1);
    const bool are_stated = x_N_per_s > Scalar(0) && y_N_per_s > Scalar(0) && spindle_drift_N_per_s(p) > Scalar(0);
    const Scalar larger_N_per_s = x_N_per_s > y_N_per_s ? x_N_per_s : y_N_per_s;
    return are_stated ? larger_N_per_s : Scalar(0);
}

template <typename Scalar>
DriftDoubt<Scalar>::DriftDoubt(const Parameters<Scalar>& parameters)
    : steady_cut_(axis_drift_N_per_s(parameters)),
      slow_fall_(spindle_drift_N_per_s(parameters)),
      entry_feed_per_tooth_mm_(parameters.tool.control.entry_feed_per_tooth_mm) {}

template <typename Scalar>
void DriftDoubt<Scalar>::clear() {
    steady_cut_.clear();
    lone_fall_.clear();
    slow_fall_.clear();
    dip_.stop();
    pause_ = 0;
    held_mm_s_ = Scalar(0);
}

template <typename Scalar>
PossibleForce<Scalar> DriftDoubt<Scalar>::follow(const Estimate& e, Scalar tooth_force_N, Scalar period_s,
                                                 const DoubtStage& stage) {
    const Scalar by_two_forces_N = by_two_forces(e, tooth_force_N, period_s, stage);
    ask(e, stage);
    PossibleForce<Scalar> possible{by_two_forces_N, by_two_forces_N > tooth_force_N};
    if (!e.x_N.valid && !e.y_N.valid && !stage.cut_is_known) {
        if (stage.in_cut) {
            slow_fall_.follow(e, period_s);
        }
        possible.tooth_N *= slow_fall_.largest_ratio(e);
    }
    return possible;
}

/// 1/√f, 0 without a feed.
template <typename Scalar>
Scalar DriftDoubt<Scalar>::per_root_feed(const Estimate& e) {
    using std::sqrt;
    return e.feed_per_tooth_mm > Scalar(0) ? Scalar(1) / sqrt(e.feed_per_tooth_mm) : Scalar(0);
}

template <typename Scalar>
bool DriftDoubt<Scalar>::may_still_cut(const Estimate& e) const {
    return lone_fall_.axes_still_cut(e, per_root_feed(e));
}

template <typename Scalar>
Scalar DriftDoubt<Scalar>::by_two_forces(const Estimate& e, Scalar tooth_force_N, Scalar period_s,
                                         const DoubtStage& stage) {
    const Scalar per_root = per_root_feed(e);
    const bool was_doubtful = steady_cut_.is_doubtful();
    if (stage.in_cut) {
        steady_cut_.follow(e, per_root, period_s);
    } else if (!stage.is_cutting) {
        steady_cut_.leave_cut();
        lone_fall_.leave_cut();
    }
    const Scalar by_steady_cut_N = steady_cut_.largest_force_N(e, tooth_force_N);
    const Scalar largest_N = lone_fall_.largest_force_N(e, by_steady_cut_N, per_root, stage.in_cut);
    if (was_doubtful && steady_cut_.begins() && !(held_mm_s_ > Scalar(0)) && period_s > Scalar(0)) {
        const Scalar entry_mm_s = entry_feed_per_tooth_mm_ / period_s;
        held_mm_s_ = e.feed_mm_s > entry_mm_s ? e.feed_mm_s : entry_mm_s;
        pause_ = 0;  // another cut, another question
    }
    return largest_N;
}

template <typename Scalar>
void DriftDoubt<Scalar>::ask(const Estimate& e, const DoubtStage& stage) {
    pause_ = static_cast<std::uint8_t>(pause_ > 0 ? pause_ - 1 : 0);
    if (stage.cut_is_known || stage.width_is_seen) {
        dip_.stop();
        held_mm_s_ = Scalar(0);
    } else if (!stage.in_cut || !steady_cut_.has_settled()) {
        dip_.stop();
    } else if (dip_.is_asking()) {
        take(dip_.follow(e));
    } else if (pause_ == 0 && (steady_cut_.has_question() || held_mm_s_ > Scalar(0))) {
        dip_.ask(e.feed_mm_s);
    }
}

template <typename Scalar>
void DriftDoubt<Scalar>::take(typename FeedDip<Scalar>::Answer answer) {
    constexpr std::uint8_t pause = 100;
    if (answer == FeedDip<Scalar>::Answer::none) {
        return;
    }
    const bool is_sound = answer == FeedDip<Scalar>::Answer::alike;
    steady_cut_.take_answer(is_sound);
    held_mm_s_ = is_sound ? Scalar(0) : held_mm_s_;
    pause_ = is_sound ? std::uint8_t{0} : pause;
}

}  // namespace millforce::firmware
