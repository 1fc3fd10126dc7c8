// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/signal/synchronous_average.hpp"

namespace millforce::estimation {

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::SynchronousAverage(const Settings& settings)
    : settings_(settings), pitch_rev_(Scalar(1) / Scalar(settings.teeth)) {}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
void SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::restart() {
    available_ = 0;
    has_previous_ = false;
    period_is_whole_ = false;
    begin_period();
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
int SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev,
                                                                 const Signals& signals, std::uint32_t present) {
    int completed = 0;
    if (has_previous_ && gap_is_too_long(dt_s, turned_rev)) {
        restart();
    } else if (has_previous_) {
        previous_dt_s_ = dt_s;
        completed = split_at_boundaries({dt_s, turned_rev, signals, present & previous_present_}, angle_rev);
    }
    if (!has_previous_) {
        to_boundary_rev_ = pitch_rev_ - offset_in_pitch(angle_rev);
        has_previous_ = true;
    }
    previous_signals_ = signals;
    previous_present_ = present;
    return completed;
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
bool SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::gap_is_too_long(Scalar dt_s, Scalar turned_rev) const {
    if (!(dt_s > Scalar(0)) || dt_s > settings_.max_gap_s) {
        return true;
    }
    // A sample interval of half as much again as the last one is a missed sample; it may hide at most half a tooth.
    const bool misses_a_sample = previous_dt_s_ > Scalar(0) && dt_s > previous_dt_s_ + halved(previous_dt_s_);
    return misses_a_sample && turned_rev - turned_rev * previous_dt_s_ / dt_s > halved(pitch_rev_);
}

/// Returns how many tooth periods were completed.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
int SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::split_at_boundaries(const Interval& interval,
                                                                                 Scalar angle_rev) {
    int completed = 0;
    bool has_crossed = false;
    Scalar from_share{0};
    Scalar left_rev = interval.turned_rev;
    while (interval.turned_rev > Scalar(0) && !(left_rev < to_boundary_rev_)) {
        const Scalar step_rev = to_boundary_rev_ > Scalar(0) ? to_boundary_rev_ : Scalar(0);
        const Scalar to_share = from_share + step_rev / interval.turned_rev;
        accumulate(interval, from_share, to_share);
        const Signals at_boundary = previous_signals_ + (interval.signals - previous_signals_) * to_share;
        completed += close_period(at_boundary.template tail<Rates>());
        has_crossed = true;
        from_share = to_share;
        left_rev -= step_rev;
        to_boundary_rev_ = pitch_rev_;
    }
    accumulate(interval, from_share, Scalar(1));
    to_boundary_rev_ -= left_rev;
    if (has_crossed) {  // counting on would add up rounding
        to_boundary_rev_ = distance_to_boundary(angle_rev, to_boundary_rev_);
    }
    return completed;
}

/// Adds the part of an interval between two shares of it. The integral of a line over a part is the length of the part
/// times the line's value in its middle.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
void SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::accumulate(const Interval& interval, Scalar from_share,
                                                                         Scalar to_share) {
    const Scalar share = to_share - from_share;
    const Scalar part_rev = share * interval.turned_rev;
    const Scalar end_weight_rev = part_rev * halved(from_share + to_share);
    sum_ += previous_signals_ * (part_rev - end_weight_rev) + interval.signals * end_weight_rev;
    turned_rev_ += part_rev;
    duration_s_ += share * interval.dt_s;
    samples_ += share;
    present_ &= interval.present;
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
void SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::begin_period() {
    sum_.setZero();
    turned_rev_ = Scalar(0);
    duration_s_ = Scalar(0);
    samples_ = Scalar(0);
    present_ = ~0U;
}

/// Returns 1 where the period was seen as a whole.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
int SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::close_period(const RateSignals& at_boundary) {
    const bool is_whole = period_is_whole_ && turned_rev_ > Scalar(0) && duration_s_ > Scalar(0);
    if (is_whole) {
        newest_ = newest_ + 1 < periods_.size() ? newest_ + 1 : 0;
        available_ = available_ < MaxPeriods ? available_ + 1 : MaxPeriods;
        Means& period = periods_[newest_];
        period.mean = sum_ * (Scalar(1) / turned_rev_);
        period.present = present_;
        period.duration_s = duration_s_;
        period.samples = samples_;
        at_starts_[newest_] = at_start_;
    }
    at_start_ = at_boundary;
    period_is_whole_ = true;
    begin_period();
    return is_whole ? 1 : 0;
}

/// From the angle to the next tooth boundary. Rounding may put the angle on the wrong side of a boundary; the distance
/// expected from counting on decides which one is meant. May be negative: the boundary has just passed.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
Scalar SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::distance_to_boundary(Scalar angle_rev,
                                                                                     Scalar expected_rev) const {
    const Scalar distance = pitch_rev_ - offset_in_pitch(angle_rev);
    const Scalar half_pitch_rev = halved(pitch_rev_);
    if (distance - expected_rev > half_pitch_rev) {
        return distance - pitch_rev_;
    }
    return expected_rev - distance > half_pitch_rev ? distance + pitch_rev_ : distance;
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
Scalar SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::offset_in_pitch(Scalar angle_rev) const {
    const auto whole = static_cast<int>(angle_rev * Scalar(settings_.teeth));
    const Scalar offset = angle_rev - Scalar(whole) * pitch_rev_;
    return offset < Scalar(0) ? Scalar(0) : offset;
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
Scalar SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::tooth_speed_rad_s() const {
    return turn_rad<Scalar> * pitch_rev_ / tooth().duration_s;
}

/// Of the period that ended `back` periods before the last one.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
std::size_t SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::place(int back) const {
    const auto periods_back = static_cast<std::size_t>(back);
    return newest_ >= periods_back ? newest_ - periods_back : newest_ - periods_back + periods_.size();
}

/// The least whole revolutions that hold min_samples; 0: there are not enough.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
int SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::periods_of_window() const {
    // What a sum of shares may fall short of a whole number of samples by, by rounding and by the encoder's counts.
    constexpr Scalar sum_error_samples = literal<Scalar>(0.05L);
    Scalar samples{0};
    for (int count = 0; count + settings_.teeth <= available_;) {
        for (int tooth = 0; tooth < settings_.teeth; ++tooth, ++count) {
            samples += at(count).samples;
        }
        if (samples > settings_.min_samples - sum_error_samples) {
            return count;
        }
    }
    return 0;
}

/// Mean over so many periods, the newest of which ended `back` periods before the last one.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
Scalar SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::speed_rad_s(int back, int periods) const {
    Scalar duration_s{0};
    for (int k = back; k < back + periods; ++k) {
        duration_s += at(k).duration_s;
    }
    return Scalar(periods) * turn_rad<Scalar> * pitch_rev_ / duration_s;
}

/// How the speed at the window's end differs from that at its start. Both are read off a line through the two stretches
/// before them: the same teeth, so that what repeats with each revolution cancels. Until so much has been seen, the
/// newer half is compared with the older one, and the whole average is uncertain.
template <typename Scalar, int Channels, int Rates, int MaxPeriods>
void SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::set_acceleration(Window& window) const {
    const int count = window.tooth_periods;
    const int longest = (MaxPeriods - count) / 2;
    const int quarter = count < 4 ? 1 : count / 4;
    const int span = quarter < longest ? quarter : longest;
    const Scalar per_s = Scalar(1) / window.duration_s;
    if (span > 0 && available_ >= count + 2 * span) {
        const Scalar newer = speed_rad_s(0, span) - speed_rad_s(count, span);
        const Scalar older = speed_rad_s(span, span) - speed_rad_s(count + span, span);
        window.spindle_acceleration_change_rad_s2 = halved(newer - older) * per_s;
        window.spindle_acceleration_rad_s2 = newer * per_s + window.spindle_acceleration_change_rad_s2;
        window.speed_span_s = window.duration_s * Scalar(span) / Scalar(count);
    } else if (count > 1) {
        const int half = count / 2;
        const Scalar apart_s = window.duration_s * Scalar(count - half) / Scalar(count);
        window.spindle_acceleration_rad_s2 = (speed_rad_s(0, half) - speed_rad_s(count - half, half)) / apart_s;
        window.spindle_acceleration_change_rad_s2 = window.spindle_acceleration_rad_s2;
        window.speed_span_s = halved(window.duration_s);
    }
}

template <typename Scalar, int Channels, int Rates, int MaxPeriods>
typename SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::Window
SynchronousAverage<Scalar, Channels, Rates, MaxPeriods>::window() const {
    Window window;
    const int count = periods_of_window();
    if (count == 0) {
        return window;
    }
    window.revolutions = count / settings_.teeth;
    window.tooth_periods = count;
    window.present = ~0U;
    for (int k = 0; k < count; ++k) {
        const Means& period = at(k);
        window.mean += period.mean;
        window.present &= period.present;
        window.samples += period.samples;
        window.duration_s += period.duration_s;
    }
    window.mean *= Scalar(1) / Scalar(count);
    window.spindle_speed_rad_s = Scalar(count) * turn_rad<Scalar> * pitch_rev_ / window.duration_s;
    set_acceleration(window);
    window.rate_per_s = (at_start_ - at_starts_[place(count - 1)]) * (Scalar(1) / window.duration_s);
    return window;
}

}  // namespace millforce::estimation
