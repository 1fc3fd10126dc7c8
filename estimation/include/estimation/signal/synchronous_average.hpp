// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

#include <Eigen/Core>
#include <concepts>
#include <cstdint>

/// Averages of drive signals over spindle angle, per tooth period and per window of whole revolutions.
///
/// Samples come at any rate, evenly or not. Each signal is taken as linear between two samples and integrated over
/// the angle turned, and the integral is split exactly at the tooth boundaries; so the averages are those over the
/// angle whatever the ratio of sampling rate to tooth-passing rate, without beat between the two.
///
/// A gap in the samples shorter than half a tooth period is bridged by the same line. A longer one, a reversal or a
/// slipped index starts the averages anew: no average is ever made of an unseen stretch.

namespace millforce::estimation {

/// `FirstSlope`: the first of the signals whose slope is asked for; the slopes of those before it are not worked out.
template <typename Scalar, int Channels, int FirstSlope = 0, int MaxPeriods = 48>
class SynchronousAverage {
  public:
    using Signals = Eigen::Matrix<Scalar, Channels, 1>;
    using Slopes = Eigen::Matrix<Scalar, Channels - FirstSlope, 1>;

    struct Settings {
        int teeth = 4;           ///< tooth periods per revolution, 1…12
        Scalar min_samples{12};  ///< a window has at least this many samples, rounded up to whole revolutions
        Scalar max_gap_s{static_cast<Scalar>(
            0.05L)};  ///< a longer gap between samples starts anew, however slowly the spindle turns
    };

    /// The means over one tooth period or one window.
    struct Means {
        Signals mean = Signals::Zero();
        std::uint32_t present = 0;  ///< bit k: signal k was there in every sample of the average
        Scalar duration_s{0};
        Scalar samples{0};
    };

    /// The last whole revolutions, and how the spindle and the signals changed across them.
    struct Window : Means {
        Scalar spindle_speed_rad_s{0};
        Scalar spindle_acceleration_rad_s2{0};
        Slopes slope_per_s = Slopes::Zero();  ///< of each signal from FirstSlope on: newer half against older half
        int revolutions = 0;                  ///< 0: not enough has been seen since the last start
        int tooth_periods = 0;                ///< of them
    };

    explicit SynchronousAverage(const Settings& settings = {})
        : settings_(settings), pitch_rev_(Scalar(1) / Scalar(settings.teeth)) {}

    [[gnu::cold, gnu::noinline]] void restart() {
        available_ = 0;
        has_previous_ = false;
        period_is_whole_ = false;
        begin_period();
    }

    /// Adds one sample. `turned_rev` since the last sample (0 ≤ turned < 0.45), `angle_rev` after it (0…1).
    /// Returns how many tooth periods were completed (0 or more).
    int add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, const Signals& signals, std::uint32_t present) {
        return add(
            dt_s, turned_rev, [angle_rev] { return angle_rev; }, signals, present);
    }
    /// The same with an angle that is asked for where it is needed. Inlined: it is most of a tick.
    template <std::invocable Angle>
    [[gnu::always_inline]] int add(Scalar dt_s, Scalar turned_rev, Angle angle_rev, const Signals& signals,
                                   std::uint32_t present) {
        if (has_previous_ && dt_s != previous_dt_s_) {
            take_interval(dt_s, turned_rev);
        }
        if (!has_previous_) {
            has_previous_ = true;
            to_boundary_rev_ = pitch_rev_ - offset_in_pitch(angle_rev());
            remember(signals, present);
            return 0;
        }
        int completed = 0;
        if (turned_rev < to_boundary_rev_ || !(turned_rev > Scalar(0))) {
            to_boundary_rev_ -= turned_rev;  // counted on; the angle itself is asked at each boundary
            accumulate_whole(dt_s, turned_rev, present);
        } else {
            Signals in_memory;  // here alone: elsewhere they stay in registers
            copy(signals, in_memory);
            completed = cross_boundaries(dt_s, turned_rev, angle_rev(), in_memory, present);
        }
        remember(signals, present);
        return completed;
    }

    /// The tooth period that ended last. Valid after add() returned at least 1 since the last start.
    [[nodiscard]] const Means& tooth() const { return periods_[newest_]; }
    [[nodiscard]] Scalar tooth_speed_rad_s() const { return two_pi * pitch_rev_ / tooth().duration_s; }
    [[nodiscard]] bool has_tooth() const { return available_ > 0; }

    /// The same tooth in the revolution before. Valid after more periods than teeth since the last start.
    [[nodiscard]] const Means& tooth_before() const { return at(settings_.teeth); }
    [[nodiscard]] bool has_tooth_before() const { return available_ > settings_.teeth; }

    /// The newest whole revolutions that hold at least min_samples. Cost: linear in the periods of the window.
    [[nodiscard]] Window window() const {
        Window window;
        read_window(window);
        return window;
    }
    void read_window(Window& window) const {
        int count = 0;
        Scalar samples{0};
        int wanted = 0;
        while (wanted == 0 && count + settings_.teeth <= available_) {
            for (int k = 0; k < settings_.teeth; ++k) {
                samples += at(count + k).samples;
            }
            count += settings_.teeth;
            if (samples > settings_.min_samples - sum_error_samples) {
                wanted = count;
            }
        }
        if (wanted == 0) {
            window = {};
            return;
        }
        sum_up(wanted, window);
        window.revolutions = wanted / settings_.teeth;
        window.tooth_periods = wanted;
    }

  private:
    /// An interval in which a tooth boundary lies, or several.
    [[gnu::noinline]] int cross_boundaries(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, const Signals& signals,
                                           std::uint32_t present) {
        const std::uint32_t both_present = present & previous_present_;
        const Scalar step_rev = to_boundary_rev_ > Scalar(0) ? to_boundary_rev_ : Scalar(0);
        Scalar share = step_rev / turned_rev;
        Scalar remaining_rev = turned_rev - step_rev;
        int completed = close_period({Scalar(0), share, turned_rev, step_rev}, dt_s, signals, both_present);
        while (!(remaining_rev < pitch_rev_))
            [[unlikely]] {
                const Scalar next = share + pitch_rev_ / turned_rev;
                begin_period();
                completed += close_period({share, next, turned_rev, pitch_rev_}, dt_s, signals, both_present);
                share = next;
                remaining_rev -= pitch_rev_;
            }
        to_boundary_rev_ = distance_to_boundary(angle_rev, pitch_rev_ - remaining_rev);
        const Weights weights = weights_of({share, Scalar(1), turned_rev, remaining_rev});
        sum_ = previous_signals_ * weights.previous_rev;
        pending_rev_ = weights.present_rev;
        turned_rev_ = remaining_rev;
        samples_ = Scalar(1) - share;
        duration_s_ = samples_ * dt_s;
        present_ = both_present;
        return completed;
    }

    /// Of the interval between the previous sample and the present one.
    struct Part {
        Scalar from_share;
        Scalar to_share;
        Scalar turned_rev;  ///< in the whole interval
        Scalar step_rev;    ///< in this part
    };

    /// Of the samples at both ends of an interval, in the integral of the line between them over a part of it.
    struct Weights {
        Scalar previous_rev;
        Scalar present_rev;
    };
    static Weights weights_of(const Part& part) {
        const Scalar part_rev = (part.to_share - part.from_share) * part.turned_rev;
        const Scalar present_rev = part_rev * halved(part.from_share + part.to_share);
        return {part_rev - present_rev, present_rev};
    }

    void take_interval(Scalar dt_s, Scalar turned_rev) {
        if (gap_is_too_long(dt_s, turned_rev)) {
            restart();
        } else {
            previous_dt_s_ = dt_s;
        }
    }

    [[nodiscard]] bool gap_is_too_long(Scalar dt_s, Scalar turned_rev) const {
        if (!(dt_s > Scalar(0)) || dt_s > settings_.max_gap_s) {
            return true;
        }
        // A sample interval that was twice the last one is a missed sample; it may hide at most half a tooth.
        if (!(previous_dt_s_ > Scalar(0)) || !(dt_s > previous_dt_s_ + halved(previous_dt_s_))) {
            return false;
        }
        return turned_rev - turned_rev * previous_dt_s_ / dt_s > halved(pitch_rev_);
    }

    /// From the angle to the next tooth boundary. Rounding may put the angle on the wrong side of a boundary; the
    /// distance expected from counting on tells which one is meant. May be negative: the boundary has just passed.
    [[nodiscard]] Scalar distance_to_boundary(Scalar angle_rev, Scalar expected_rev) const {
        const Scalar distance = pitch_rev_ - offset_in_pitch(angle_rev);
        const Scalar half_pitch_rev = halved(pitch_rev_);
        if (distance - expected_rev > half_pitch_rev) {
            return distance - pitch_rev_;
        }
        return expected_rev - distance > half_pitch_rev ? distance + pitch_rev_ : distance;
    }

    [[nodiscard]] Scalar offset_in_pitch(Scalar angle_rev) const {
        const auto whole = static_cast<int>(angle_rev * Scalar(settings_.teeth));
        const Scalar offset = angle_rev - Scalar(whole) * pitch_rev_;
        return offset < Scalar(0) ? Scalar(0) : offset;
    }

    void remember(const Signals& signals, std::uint32_t present) {
        copy(signals, previous_signals_);
        previous_present_ = present;
    }

    /// One by one: the compiler keeps what is never copied as a whole in registers.
    [[gnu::always_inline]] static void copy(const Signals& from, Signals& to) {
#pragma GCC unroll 16
        for (int k = 0; k < Channels; ++k) {
            to[k] = from[k];
        }
    }

    /// Adds a whole interval between the previous sample and the present one, as is usual. A line's integral is the
    /// mean of its ends times the way: the previous sample gets half of the way before it and half of this one, and the
    /// present one waits for its next.
    void accumulate_whole(Scalar dt_s, Scalar turned_rev, std::uint32_t present) {
        const Scalar half_rev = halved(turned_rev);
        const Scalar weight_rev = pending_rev_ + half_rev;
#pragma GCC unroll 16
        for (int k = 0; k < Channels; ++k) {
            sum_[k] += product(previous_signals_[k], weight_rev);
        }
        pending_rev_ = half_rev;
        turned_rev_ += turned_rev;
        duration_s_ += dt_s;
        samples_ += Scalar(1);
        present_ &= present & previous_present_;
    }

    /// With a part of an interval, which ends at a boundary. Returns how many tooth periods were completed by it.
    int close_period(const Part& part, Scalar dt_s, const Signals& signals, std::uint32_t both_present) {
        const Scalar share = part.to_share - part.from_share;
        const Scalar turned_rev = turned_rev_ + part.step_rev;
        const Scalar duration_s = duration_s_ + share * dt_s;
        const bool is_whole = period_is_whole_ && turned_rev > Scalar(0) && duration_s > Scalar(0);
        period_is_whole_ = true;
        if (!is_whole) {
            return 0;
        }
        newest_ = newest_ + 1 < MaxPeriods ? newest_ + 1 : 0;
        available_ = available_ < MaxPeriods ? available_ + 1 : MaxPeriods;
        const Weights last = weights_of(part);
        Means& period = periods_[newest_];
        const Scalar previous_rev = pending_rev_ + last.previous_rev;
        const Scalar per_rev = Scalar(1) / turned_rev;
#pragma GCC unroll 16
        for (int k = 0; k < Channels; ++k) {
            const Scalar ends = product(previous_signals_[k], previous_rev) + product(signals[k], last.present_rev);
            period.mean[k] = product(sum_[k] + ends, per_rev);
        }
        period.present = present_ & both_present;
        period.duration_s = duration_s;
        period.samples = samples_ + share;
        return 1;
    }

    void begin_period() {
        sum_.setZero();
        turned_rev_ = Scalar(0);
        duration_s_ = Scalar(0);
        samples_ = Scalar(0);
        pending_rev_ = Scalar(0);
        present_ = ~0U;
    }

    void sum_up(int count, Window& window) const {
        std::uint32_t present = ~0U;
        Scalar samples{0};
        Scalar duration_s{0};
        Scalar newer_duration_s{0};
        Scalar older_duration_s{0};
        Slopes newer = Slopes::Zero();
        Slopes older = Slopes::Zero();
        Signals sum = Signals::Zero();
        const int half = (count + 1) / 2;
        for (int k = 0; k < count; ++k) {
            const Means& period = at(k);
            add_to(sum, period.mean, 0);
            present &= period.present;
            samples += period.samples;
            duration_s += period.duration_s;
            if (k < half) {
                add_to(newer, period.mean, FirstSlope);
                newer_duration_s += period.duration_s;
            }
            if (k >= count - half) {
                add_to(older, period.mean, FirstSlope);
                older_duration_s += period.duration_s;
            }
        }
        window.mean = sum * (Scalar(1) / Scalar(count));
        window.present = present;
        window.samples = samples;
        window.duration_s = duration_s;
        const Scalar pitch_rad = two_pi * pitch_rev_;
        const Scalar half_rad = Scalar(half) * pitch_rad;
        window.spindle_speed_rad_s = Scalar(count) * pitch_rad / duration_s;
        const Scalar apart_s = duration_s - halved(newer_duration_s + older_duration_s);
        if (apart_s > Scalar(0)) {
            window.spindle_acceleration_rad_s2 = (half_rad / newer_duration_s - half_rad / older_duration_s) / apart_s;
            window.slope_per_s = (newer - older) * (Scalar(1) / (Scalar(half) * apart_s));
        } else {
            window.spindle_acceleration_rad_s2 = Scalar(0);
            window.slope_per_s.setZero();
        }
    }

    template <typename Sum>
    static void add_to(Sum& sum, const Signals& signals, int first) {
        for (int k = 0; k < static_cast<int>(Sum::RowsAtCompileTime); ++k) {
            sum[k] += signals[first + k];
        }
    }

    /// The period that ended `back` periods before the last one.
    [[nodiscard]] const Means& at(int back) const {
        return periods_[newest_ >= back ? newest_ - back : newest_ - back + MaxPeriods];
    }

    /// What a sum of shares may fall short of a whole number of samples by, by rounding and by the encoder's counts.
    static constexpr Scalar sum_error_samples = static_cast<Scalar>(0.05L);
    static constexpr Scalar two_pi = static_cast<Scalar>(6.28318530717958647692L);

    Settings settings_;
    Scalar pitch_rev_;
    int available_ = 0;  // periods in the ring
    int newest_ = 0;     // its place

    Signals sum_ = Signals::Zero();
    Scalar turned_rev_{0};
    Scalar duration_s_{0};
    Scalar samples_{0};
    Scalar pending_rev_{0};  // by which the previous sample is still to be weighed
    std::uint32_t present_ = ~0U;
    bool period_is_whole_ = false;

    bool has_previous_ = false;
    Scalar to_boundary_rev_{0};
    Scalar previous_dt_s_{-1};
    Signals previous_signals_ = Signals::Zero();
    std::uint32_t previous_present_ = 0;

    Means periods_[static_cast<std::size_t>(MaxPeriods)];  // last: what each sample touches lies near the start
};

}  // namespace millforce::estimation
