// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

#include <Eigen/Core>
#include <array>
#include <cstdint>

/// Averages of drive signals over spindle angle, per tooth period and per window of whole revolutions.
///
/// Samples come at any rate, evenly or not. Each signal is taken as linear between two samples and integrated over
/// the angle turned, and the integral is split exactly at the tooth boundaries; so the averages are those over the
/// angle whatever the ratio of sampling rate to tooth-passing rate, without beat between the two.
///
/// A gap in the samples shorter than half a tooth period is bridged by the same line. A longer one, a reversal or a
/// slipped index restarts the averages: no average is ever made of an unseen stretch.
///
/// No heap. Not thread-safe. Bodies: synchronous_average_impl.hpp.

namespace millforce::estimation {

template <typename Scalar, int Channels, int Rates, int MaxPeriods = 36>
class SynchronousAverage {
  public:
    using Signals = Eigen::Matrix<Scalar, Channels, 1>;
    using RateSignals = Eigen::Matrix<Scalar, Rates, 1>;

    struct Settings {
        int teeth = 0;          ///< tooth periods per revolution, 1…12
        Scalar min_samples{0};  ///< a window has at least this many samples, rounded up to whole revolutions
        /// A longer gap between samples restarts the averages, however slowly the spindle turns.
        Scalar max_gap_s{literal<Scalar>(0.05L)};
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
        /// Mean acceleration: from the speeds at the window's ends, each seen over twice speed_span_s before the end.
        Scalar spindle_acceleration_rad_s2{0};
        Scalar spindle_acceleration_change_rad_s2{0};  ///< within the window: what the mean may be off by
        Scalar speed_span_s{0};
        /// Mean rate of change of the last `Rates` signals: from their values at the window's ends.
        RateSignals rate_per_s = RateSignals::Zero();
        int revolutions = 0;    ///< 0: not enough has been seen since the last restart
        int tooth_periods = 0;  ///< tooth periods of these revolutions
    };

    explicit SynchronousAverage(const Settings& settings);

    void restart();

    /// Adds one sample. `turned_rev` since the last sample (0 ≤ turned < 0.45), `angle_rev` after it (0…1).
    /// Returns how many tooth periods were completed (0 or more).
    int add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, const Signals& signals, std::uint32_t present);

    /// The tooth period that ended last. Valid after add() returned at least 1 since the last restart.
    [[nodiscard]] const Means& tooth() const { return periods_[newest_]; }
    [[nodiscard]] Scalar tooth_speed_rad_s() const;
    [[nodiscard]] bool has_tooth() const { return available_ > 0; }
    /// The same tooth one revolution before. Valid where has_turn_before().
    [[nodiscard]] const Means& tooth_one_turn_before() const { return at(settings_.teeth); }
    [[nodiscard]] bool has_turn_before() const { return available_ > settings_.teeth; }

    /// The newest whole revolutions that hold at least min_samples. Cost: linear in the periods of the window.
    [[nodiscard]] Window window() const;

  private:
    /// The line between the previous sample and the present one.
    struct Interval {
        Scalar dt_s;
        Scalar turned_rev;
        const Signals& signals;  ///< at its end
        std::uint32_t present;   ///< at both ends
    };

    [[nodiscard]] bool gap_is_too_long(Scalar dt_s, Scalar turned_rev) const;
    int split_at_boundaries(const Interval& interval, Scalar angle_rev);
    void accumulate(const Interval& interval, Scalar from_share, Scalar to_share);
    void begin_period();
    int close_period(const RateSignals& at_boundary);
    [[nodiscard]] Scalar distance_to_boundary(Scalar angle_rev, Scalar expected_rev) const;
    [[nodiscard]] Scalar offset_in_pitch(Scalar angle_rev) const;
    [[nodiscard]] int periods_of_window() const;
    [[nodiscard]] Scalar speed_rad_s(int back, int periods) const;
    void set_acceleration(Window& window) const;
    [[nodiscard]] std::size_t place(int back) const;
    [[nodiscard]] const Means& at(int back) const { return periods_[place(back)]; }

    Settings settings_;
    Scalar pitch_rev_;

    Signals sum_ = Signals::Zero();  // of the period that has begun: integral over the angle
    Scalar turned_rev_{0};
    Scalar duration_s_{0};
    Scalar samples_{0};
    std::uint32_t present_ = ~0U;
    RateSignals at_start_ = RateSignals::Zero();
    bool period_is_whole_ = false;  // seen from its first boundary on

    bool has_previous_ = false;
    Scalar to_boundary_rev_{0};
    Scalar previous_dt_s_{-1};
    Signals previous_signals_ = Signals::Zero();
    std::uint32_t previous_present_ = 0;

    std::array<Means, static_cast<std::size_t>(MaxPeriods)> periods_{};  // a ring
    std::array<RateSignals, static_cast<std::size_t>(MaxPeriods)> at_starts_{};
    int available_ = 0;  // periods in them
    std::size_t newest_ = 0;
};

}  // namespace millforce::estimation
