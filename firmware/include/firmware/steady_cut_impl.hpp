// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/elementary.hpp"
#include "estimation/number/literal.hpp"
#include "firmware/steady_cut.hpp"

namespace millforce::firmware {

template <typename Scalar>
static bool differs(Scalar value, Scalar from, Scalar by) {
    return value - from > by || from - value > by;
}

template <typename Scalar>
Scalar SteadyCut<Scalar>::largest_force_N(const estimation::CutEstimate<Scalar>& e, Scalar tooth_force_N) const {
    if (!is_doubtful_ || !e.tangential_N.valid || !e.feed_N.valid) {
        return tooth_force_N;
    }
    const Scalar by_spindle_N = tooth_per_tangential_ * e.tangential_N.value;
    const Scalar by_axes_N = tooth_per_feed_force_ * e.feed_N.value;
    const Scalar larger_N = by_spindle_N > by_axes_N ? by_spindle_N : by_axes_N;
    return larger_N > tooth_force_N ? larger_N : tooth_force_N;
}

template <typename Scalar>
void SteadyCut<Scalar>::follow(const estimation::CutEstimate<Scalar>& e, Scalar per_root_feed, Scalar period_s) {
    const bool is_known = is_width_known(e.engagement) && e.engagement.depth_valid && e.feed_N.valid;
    if (!is_known || !(e.tangential_N.value > Scalar(0)) || !(per_root_feed > Scalar(0))) {
        return;
    }
    const Scalar axes_N = e.feed_N.value < Scalar(0) ? -e.feed_N.value : e.feed_N.value;
    const Cut cut{e.tangential_N.value * per_root_feed, axes_N * per_root_feed, e.engagement.radial_immersion,
                  e.engagement.axial_depth_mm};
    if (estimates_ == 0 || is_step(cut)) {
        mean_ = cut;
        estimates_ = 0;
        is_refuted_ = false;
    }
    mean_ += (cut - mean_) * Scalar(1.0F / settled);
    if (estimates_ < settled && ++estimates_ == settled) {
        begin(e);
    }
    if (has_settled() && is_faster_than_a_drift(e, period_s) && !is_doubtful_) {
        estimates_ = 0;
    }
    judge(e);
}

template <typename Scalar>
void SteadyCut<Scalar>::judge(const estimation::CutEstimate<Scalar>& e) {
    constexpr Scalar much = estimation::literal<Scalar>(1.2L);
    const bool has_moved = has_settled() && has_width_moved(e.engagement);
    const bool has_moved_in_both = has_moved && has_depth_moved(e.engagement);
    is_doubtful_ = has_moved_in_both || (has_moved && is_refuted_);
    has_question_ = has_moved && !has_moved_in_both && e.tooth_force_N.valid &&
                    tooth_per_tangential_ * e.tangential_N.value > much * e.tooth_force_N.value;
}

template <typename Scalar>
bool SteadyCut<Scalar>::is_faster_than_a_drift(const estimation::CutEstimate<Scalar>& e, Scalar period_s) {
    constexpr Scalar apart = Scalar(0.25F);
    const Scalar now_N = e.feed_N.value - feed_per_tangential_ * e.tangential_N.value;
    missing_N_ += (now_N - missing_N_) * Scalar(1.0F / settled);
    const Scalar most_N = drift_N_per_s_ * period_s * Scalar(e.tooth_periods);
    drift_N_ += estimation::clamp(missing_N_ - drift_N_, -most_N, most_N);
    return drift_N_per_s_ > Scalar(0) && differs(missing_N_, drift_N_, apart * e.tangential_N.value);
}

template <typename Scalar>
bool SteadyCut<Scalar>::is_step(const Cut& cut) const {
    constexpr Scalar step = Scalar(0.25F);
    return differs(cut[spindle], mean_[spindle], step * mean_[spindle]) &&
           differs(cut[axes], mean_[axes], step * mean_[axes]);
}

template <typename Scalar>
void SteadyCut<Scalar>::begin(const estimation::CutEstimate<Scalar>& e) {
    constexpr Scalar significant = Scalar(9);  // three standard deviations, squared
    const estimation::Measurement<Scalar>& tooth = e.tooth_force_N;
    if (!tooth.valid || e.tooth_force_is_bound) {
        estimates_ = 0;
        return;
    }
    const bool has_feed_force = estimation::square(e.feed_N.value) > significant * e.feed_N.variance;
    first_immersion_ = mean_[immersion];
    first_depth_mm_ = mean_[depth];
    tooth_per_tangential_ = tooth.value / e.tangential_N.value;
    tooth_per_feed_force_ = has_feed_force ? tooth.value / e.feed_N.value : Scalar(0);
    const Scalar along_feed = e.feed_N.value < Scalar(0) ? -mean_[Quantity::axes] : mean_[Quantity::axes];
    feed_per_tangential_ = along_feed / mean_[spindle];
    missing_N_ = drift_N_ = Scalar(0);
}

template <typename Scalar>
bool SteadyCut<Scalar>::has_width_moved(const estimation::EngagementEstimate<Scalar>& engagement) const {
    return differs(mean_[immersion], first_immersion_, engagement.radial_immersion_sd);
}

template <typename Scalar>
bool SteadyCut<Scalar>::has_depth_moved(const estimation::EngagementEstimate<Scalar>& engagement) const {
    constexpr Scalar least_share = estimation::literal<Scalar>(0.15L);
    return differs(mean_[depth], first_depth_mm_, least_share * first_depth_mm_ + engagement.axial_depth_force_sd_mm);
}

}  // namespace millforce::firmware
