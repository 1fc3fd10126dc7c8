// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of feed_ahead.hpp. Only src/feed_ahead.cpp includes them.

#include <cmath>

#include "control/feed_ahead.hpp"
#include "estimation/number/finite.hpp"

namespace millforce::control {

template <typename Scalar, std::size_t Capacity>
FeedAhead<Scalar, Capacity>::FeedAhead(const FeedAheadSettings<Scalar>& settings)
    : settings_(settings),
      latest_s_(literal<Scalar>(1.4L) * settings.reaction_s),
      hardness_(settings.assumed_hardness),
      hardening_(Scalar(1) - Scalar(1) / hardness_),
      off_unseen_mm_(settings.farthest_off_mm) {}

template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::restart() {
    empty();
    estimates_ = 0;
    agreed_mm_ = Scalar(0);
    disagreed_mm_ = Scalar(0);
    disagreements_ = 0;
    is_refuted_ = false;
}

template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::empty() {
    first_ = 0;
    count_ = 0;
    since_estimate_mm_ = Scalar(0);
    touched_in_air_ = false;
}

template <typename Scalar, std::size_t Capacity>
bool FeedAhead<Scalar, Capacity>::add(const Stretch<Scalar>& stretch) {
    const bool is_sound = estimation::is_finite(stretch.begin_mm) && is_known(stretch.feed_mm_s) &&
                          estimation::is_finite(stretch.tangential_N) && !(stretch.tangential_N < Scalar(0)) &&
                          estimation::is_finite(stretch.tooth_per_tangential) &&
                          estimation::is_finite(stretch.feed_per_tangential) && is_known(stretch.falling_share) &&
                          !(stretch.least_share < Scalar(0)) && stretch.least_share <= Scalar(1) &&
                          stretch.falling_share <= Scalar(1) && is_known(stretch.feed_per_softness);
    const bool goes_on = count_ == 0 || stretch.begin_mm > at(count_ - 1).begin_mm;
    if (room() == 0 || !is_sound || !goes_on) {
        return false;
    }
    window_[(first_ + count_) % Capacity] = stretch;
    ++count_;
    return true;
}

template <typename Scalar, std::size_t Capacity>
WayAhead<Scalar> FeedAhead<Scalar, Capacity>::step(const Step& now) {
    WayAhead<Scalar> way;
    if (!is_sound(now)) {
        return way;
    }
    follow_feed(now);
    if (!now.position_known) {
        return way;
    }
    since_estimate_mm_ += now.travel_mm;
    const bool covers = count_ > 1 && !(now.position_mm < at(0).begin_mm) && now.position_mm < at(count_ - 1).begin_mm;
    if (!covers) {
        return way;
    }
    if (now.fresh && is_known(now.mean_feed_mm_s) && estimation::is_finite(now.window_mm)) {
        compare(now);
        drop_passed(now.position_mm - now.window_mm - settings_.farthest_off_mm);
    }
    if (is_refuted_) {
        return way;
    }
    way.may_cut = may_cut_;
    way.known = !(agreed_mm_ < settings_.agreement_mm) && !is_near_unknown(now.position_mm);
    way.feed_mm_s = fastest_for(now);
    way.tooth_per_tangential = mapped_.tooth_per_tangential;
    way.tangential_N = hardness() * mapped_.tangential_N;
    return way;
}

template <typename Scalar, std::size_t Capacity>
bool FeedAhead<Scalar, Capacity>::is_sound(const Step& now) {
    return estimation::is_finite(now.position_mm) && estimation::is_finite(now.travel_mm) &&
           estimation::is_finite(now.dt_s) && estimation::is_finite(now.feed_mm_s) &&
           estimation::is_finite(now.asked_feed_mm_s) && estimation::is_finite(now.blind_feed_mm_s) &&
           estimation::is_finite(now.runout_mm_s) && estimation::is_finite(now.mapped_runout_mm_s);
}

/// What is asked for adds to the way that is pending, what the tool goes takes from it. A CNC that is slower than asked
/// would add without end: within the reaction time the way falls back to that of a steady change.
template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::follow_feed(const Step& now) {
    using estimation::clamp;
    const Scalar change_mm_s = settings_.acceleration_mm_s2 * now.dt_s;
    coming_feed_mm_s_ = clamp(now.asked_feed_mm_s, coming_feed_mm_s_ - change_mm_s, coming_feed_mm_s_ + change_mm_s);
    const Scalar steady_mm = estimation::halved(latest_s_ * (now.feed_mm_s + coming_feed_mm_s_));
    const Scalar share = now.dt_s < latest_s_ ? now.dt_s / latest_s_ : Scalar(1);
    pending_mm_ += now.dt_s * (coming_feed_mm_s_ - now.feed_mm_s);
    pending_mm_ += share * (steady_mm - pending_mm_);
}

template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::drop_passed(Scalar behind_mm) {
    while (count_ > 2 && end_mm(0) < behind_mm) {
        first_ = (first_ + 1) % Capacity;
        --count_;
    }
}

// ---- The measured cut against the map
// --------------------------------------------------------------------------------

template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::compare(const Step& now) {
    constexpr Scalar beyond_window_mm{Scalar(0.5F)};
    const Expected expected = expected_within(now, settings_.position_tolerance_mm);
    const Scalar travel_mm = since_estimate_mm_ < now.window_mm ? since_estimate_mm_ : now.window_mm;
    const bool is_in_contact = now.tangential_N > now.contact_level_N;
    const bool touches_in_air = is_in_contact && !expected.has_unknown && !(expected.tangential_N.high > Scalar(0));
    since_estimate_mm_ = Scalar(0);
    const Scalar late_mm = now.window_mm + beyond_window_mm;
    off_unseen_mm_ = late_mm > settings_.farthest_off_mm ? late_mm : settings_.farthest_off_mm;
    mapped_ = mapped_within(now);
    may_cut_ = expected.tangential_N.high > Scalar(0);
    is_refuted_ = is_refuted_ || (touches_in_air && touched_in_air_);
    touched_in_air_ = touches_in_air;
    if (!force_agrees(now, expected) || !direction_agrees(now, expected)) {
        disagreed_mm_ += travel_mm;
        disagreements_ = disagreements_ < enough_disagreements ? disagreements_ + 1 : disagreements_;
        is_refuted_ =
            is_refuted_ || (disagreed_mm_ > settings_.disagreement_mm && disagreements_ == enough_disagreements);
        return;
    }
    disagreed_mm_ = Scalar(0);
    disagreements_ = 0;
    if (is_in_contact && !expected.has_unknown && expected.tangential_N.low > Scalar(0)) {
        agreed_mm_ += travel_mm * expected.tangential_N.low / expected.tangential_N.high;
        measure_hardness(now, expected_within(now, settings_.farthest_off_mm).tangential_N);
    }
}

template <typename Scalar, std::size_t Capacity>
bool FeedAhead<Scalar, Capacity>::force_agrees(const Step& now, const Expected& expected) const {
    using estimation::clamp;
    if (expected.has_unknown) {
        return true;
    }
    const Scalar lowest = settings_.lowest_hardness;
    const Scalar highest = settings_.highest_hardness;
    const Scalar softest = is_hardness_measured_ ? clamp(hardness_ / settings_.hardness_band, lowest, highest) : lowest;
    const Scalar hardest =
        is_hardness_measured_ ? clamp(hardness_ * settings_.hardness_band, lowest, highest) : highest;
    const Scalar noise_N = significance * now.tangential_sd_N;
    const Scalar most_N = expected.tangential_N.high * hardest + noise_N;
    const Scalar least_N = expected.tangential_N.low * softest - noise_N;
    return (now.tangential_N <= most_N || now.tangential_N <= now.contact_level_N) && now.tangential_N >= least_N;
}

template <typename Scalar, std::size_t Capacity>
bool FeedAhead<Scalar, Capacity>::direction_agrees(const Step& now, const Expected& expected) const {
    if (expected.has_open || !now.feed_force_valid || !(expected.tangential_N.high > Scalar(0)) ||
        !(now.tangential_N > now.contact_level_N)) {
        return true;
    }
    const Scalar noise_N = significance * now.feed_force_sd_N;
    const Scalar least_N = (expected.direction.low - settings_.direction_band) * now.tangential_N - noise_N;
    const Scalar most_N = (expected.direction.high + settings_.direction_band) * now.tangential_N + noise_N;
    return now.feed_force_N >= least_N && now.feed_force_N <= most_N;
}

/// Averaged over some ten estimates, F_at is κ times a force between the averages of the least and of the most.
template <typename Scalar, std::size_t Capacity>
void FeedAhead<Scalar, Capacity>::measure_hardness(const Step& now, const Range& expected_N) {
    constexpr Scalar weight = literal<Scalar>(0.1L);             // of one estimate
    constexpr Scalar noise_of_average = literal<Scalar>(0.23L);  // √(weight/(2 − weight))
    constexpr Scalar determined = literal<Scalar>(0.9L);
    if (!(expected_N.low > Scalar(0))) {
        return;
    }
    const bool is_first = !(highest_N_ > Scalar(0));
    const auto average = [&](Scalar& mean_N, Scalar value_N) {
        mean_N = is_first ? value_N : mean_N + weight * (value_N - mean_N);
    };
    average(measured_N_, now.tangential_N);
    average(lowest_N_, expected_N.low);
    average(highest_N_, expected_N.high);
    const Scalar noise_N = noise_of_average * now.tangential_sd_N;
    estimates_ = estimates_ < enough_estimates ? estimates_ + 1 : estimates_;
    const bool is_too_soft = measured_N_ + significance * noise_N < settings_.lowest_hardness * lowest_N_;
    is_refuted_ = is_refuted_ || (estimates_ == enough_estimates && is_too_soft);
    const Scalar least = measured_N_ / highest_N_;
    const Scalar most = (measured_N_ + noise_N) / lowest_N_;
    hardness_ = estimation::clamp(estimation::clamp(hardness_, least, most), settings_.lowest_hardness,
                                  settings_.highest_hardness);
    hardening_ = Scalar(1) - Scalar(1) / hardness_;
    is_hardness_measured_ = is_hardness_measured_ || !(lowest_N_ < determined * highest_N_);
}

template <typename Scalar, std::size_t Capacity>
auto FeedAhead<Scalar, Capacity>::expected_within(const Step& now, Scalar tolerance_mm) const -> Expected {
    Expected expected;
    const Scalar cutting = cutting_teeth_share(now);
    for_each_within(now.position_mm - now.window_mm - tolerance_mm, now.position_mm + tolerance_mm, [&](std::size_t i) {
        const Scalar force_N = force_at(i, now.mean_feed_mm_s);
        const Scalar edges_missing_N = (Scalar(1) - cutting) * (Scalar(1) - at(i).falling_share) * at(i).tangential_N;
        expected.has_unknown = expected.has_unknown || !at(i).is_known;
        expected.has_open = expected.has_open || at(i).is_open();
        expected.tangential_N.include(force_N);
        expected.tangential_N.include(at(i).least_share * (force_N - edges_missing_N));
        if (force_N > Scalar(0)) {
            expected.direction.include(at(i).feed_per_tangential);
        }
    });
    return expected;
}

/// The tooth's force is the largest within the window, for the largest F_at.
template <typename Scalar, std::size_t Capacity>
auto FeedAhead<Scalar, Capacity>::mapped_within(const Step& now) const -> Mapped {
    const Scalar begin_mm = now.position_mm - now.window_mm;
    Scalar tooth_N{0};
    Scalar highest_N{0};
    Scalar sum_N_mm{0};
    bool has_open = false;
    for_each_within(begin_mm, now.position_mm, [&](std::size_t i) {
        has_open = has_open || at(i).is_open();
        const Scalar force_N = force_at(i, now.mean_feed_mm_s);
        const Scalar of_tooth_N = force_N * at(i).tooth_per_tangential;
        tooth_N = of_tooth_N > tooth_N ? of_tooth_N : tooth_N;
        highest_N = force_N > highest_N ? force_N : highest_N;
        const Scalar from_mm = at(i).begin_mm > begin_mm ? at(i).begin_mm : begin_mm;
        const Scalar to_mm = end_mm(i) < now.position_mm ? end_mm(i) : now.position_mm;
        sum_N_mm += force_N * (to_mm - from_mm);
    });
    Mapped mapped;
    if (has_open) {
        return mapped;
    }
    mapped.tooth_per_tangential = highest_N > Scalar(0) ? tooth_N / highest_N : Scalar(0);
    mapped.tangential_N = now.window_mm > Scalar(0) ? sum_N_mm / now.window_mm : highest_N;
    return mapped;
}

template <typename Scalar, std::size_t Capacity>
template <typename Visit>
void FeedAhead<Scalar, Capacity>::for_each_within(Scalar from_mm, Scalar to_mm, const Visit& visit) const {
    for (std::size_t i = 0; i + 1 < count_ && at(i).begin_mm <= to_mm; ++i) {
        if (!(end_mm(i) < from_mm)) {
            visit(i);
        }
    }
}

/// The least share of the teeth that can cut: none takes more than a chip and the runout, and all chips together are
/// those of the feed.
template <typename Scalar, std::size_t Capacity>
Scalar FeedAhead<Scalar, Capacity>::cutting_teeth_share(const Step& now) {
    if (!(now.mean_feed_mm_s < now.runout_mm_s)) {
        return Scalar(1);
    }
    const Scalar share = now.mean_feed_mm_s / (now.mean_feed_mm_s + now.runout_mm_s);
    return share > now.tooth_share ? share : now.tooth_share;
}

/// F_at at κ = 1.
template <typename Scalar, std::size_t Capacity>
Scalar FeedAhead<Scalar, Capacity>::force_at(std::size_t i, Scalar feed_mm_s) const {
    const Stretch<Scalar>& stretch = at(i);
    return stretch.tangential_N * (Scalar(1) - stretch.falling_share * (Scalar(1) - feed_mm_s / stretch.feed_mm_s));
}

// ---- The feed
// --------------------------------------------------------------------------------------------------------

template <typename Scalar, std::size_t Capacity>
bool FeedAhead<Scalar, Capacity>::is_near_unknown(Scalar position_mm) const {
    bool is_near = false;
    for_each_within(position_mm - settings_.farthest_off_mm, position_mm + settings_.farthest_off_mm,
                    [&](std::size_t i) { is_near = is_near || !at(i).is_known; });
    return is_near;
}

/// v_i
template <typename Scalar, std::size_t Capacity>
Scalar FeedAhead<Scalar, Capacity>::feed_at(std::size_t i, const Step& now) const {
    const Stretch<Scalar>& stretch = at(i);
    if (!stretch.is_known) {
        return now.blind_feed_mm_s;
    }
    if (!(stretch.tangential_N > Scalar(0))) {
        return stretch.feed_mm_s;
    }
    const Scalar ratio = Scalar(1) - stretch.feed_per_softness * hardening_;
    const Scalar feed_mm_s = ratio > Scalar(0) ? stretch.feed_mm_s * ratio : Scalar(0);
    const Scalar least_mm_s = feed_mm_s * now.tooth_share;
    const Scalar of_worst_tooth_mm_s = feed_mm_s + now.mapped_runout_mm_s - now.runout_mm_s;
    const Scalar highest_mm_s = of_worst_tooth_mm_s > least_mm_s ? of_worst_tooth_mm_s : least_mm_s;
    const bool is_guess = stretch.is_open() || !is_hardness_measured_;
    return is_guess && highest_mm_s < now.blind_feed_mm_s ? now.blind_feed_mm_s : highest_mm_s;
}

/// In squares: one root for all.
template <typename Scalar, std::size_t Capacity>
Scalar FeedAhead<Scalar, Capacity>::fastest_for(const Step& now) const {
    using estimation::square;
    using std::sqrt;
    const Scalar twice_a = settings_.acceleration_mm_s2 + settings_.acceleration_mm_s2;
    const Scalar acts_mm = now.position_mm + pending_mm_;
    const Scalar at_this_feed_mm = latest_s_ * now.feed_mm_s;
    const Scalar surely_mm = estimation::halved(pending_mm_ < at_this_feed_mm ? pending_mm_ : at_this_feed_mm);
    const Scalar passed_mm = now.position_mm + surely_mm;
    const auto square_before = [&](Scalar feed_mm_s, Scalar begin_mm) {
        const Scalar spare_mm = begin_mm - off_unseen_mm_ - acts_mm;
        return spare_mm > Scalar(0) ? square(feed_mm_s) + twice_a * spare_mm : square(feed_mm_s);
    };
    const std::size_t last = count_ - 1;  // its begin is where the map ends
    Scalar fastest = square_before(now.blind_feed_mm_s, at(last).begin_mm);
    for (std::size_t i = 0; i < last; ++i) {
        if (end_mm(i) + off_unseen_mm_ < passed_mm) {
            continue;
        }
        const Scalar here = square_before(feed_at(i, now), at(i).begin_mm);
        fastest = here < fastest ? here : fastest;
    }
    return sqrt(fastest);
}

}  // namespace millforce::control
