// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <random>

#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

/// Signals that go wrong between a machine and its controller.

namespace millforce::faults {

enum class SignalFault : std::uint8_t {
    none,
    spindle_weak,       ///< current × 0.3
    spindle_strong,     ///< current × 3
    spindle_saturated,  ///< current never above what it was at the fault's begin
    spindle_drifts,     ///< −0.5 A/s
    spindle_drifts_up,  ///< +0.5 A/s
    spindle_low,        ///< an offset of −10 % of rated current
    spindle_high,       ///< +10 %
    spindle_frozen,     ///< the last value for good
    spindle_dead,       ///< 0 A
    spindle_reversed,
    spindle_noisy,  ///< 10 % of rated current, normally distributed
    spindle_absent,
    spindle_fair,       ///< × 0.6
    spindle_fades,      ///< × 1 falls to × 0.3 within 5 s
    spindle_rectified,  ///< its amount, without a sign
    spindle_late,       ///< by 0.2 s
    spindle_smoothed,   ///< by a time constant of 0.3 s
    spindle_cuts_out,   ///< 0 A for 20 ms, five times a second
    spindle_spikes,     ///< one sample in a hundred: rated current
    spindle_coarse,     ///< in steps of 10 % of rated current
    x_tenfold,          ///< current × 10
    x_weak,             ///< × 0.3
    x_reversed,
    x_drifts,       ///< +0.5 A/s
    x_drifts_down,  ///< −0.5 A/s
    x_high,         ///< an offset of +10 % of rated current
    x_frozen,
    x_dead,
    x_strong,  ///< × 1.7
    x_fades,   ///< × 1 falls to × 0.3 within 5 s
    x_rectified,
    x_late,
    x_cuts_out,
    x_coarse,
    y_tenfold,
    y_weak,
    y_reversed,
    y_drifts,
    y_frozen,
    y_dead,
    x_and_spindle_swapped,  ///< currents
    x_and_y_swapped,
    currents_halved,   ///< all
    velocities_huge,   ///< × 10⁶
    velocities_small,  ///< × 0.1
    velocities_zero,
    velocities_frozen,
    velocities_reversed,
    velocities_swapped,  ///< x and y
    velocities_late,     ///< by 0.2 s
    x_velocity_zero,
    encoder_double,  ///< counts twice
    encoder_half,
    encoder_loses,     ///< 3 % of the counts
    encoder_reversed,  ///< the index, too
    index_lost,        ///< no further index pulse
    encoder_frozen,
    encoder_absent,
    encoder_slips,     ///< once, by a quarter of a revolution
    encoder_stutters,  ///< stands for 30 ms, five times a second, and then counts what it missed
    not_a_number,      ///< all currents and velocities
    rapid_stuck,
    feed_told_low,  ///< F × 0.1
    feed_told_high,
    feed_not_a_number,
    operator_told_high,  ///< override × 3
    operator_not_a_number,
    hold_stuck,
    rapid_flickers,  ///< every second time
    feed_flickers,   ///< F × 10 every second time
    status_frozen,   ///< the program as it was
    all_late,        ///< sample and program by 0.2 s, with a new time
    time_frozen,
    time_backwards,
    time_double,  ///< a clock that runs twice as fast
    time_half,
    time_jitters,  ///< by up to 40 % of a sample
};
inline constexpr int signal_faults = static_cast<int>(SignalFault::time_jitters) + 1;

const char* name_of(SignalFault fault);

/// What the size of a fault is a share of.
struct Rated {
    double spindle_A = 0.0;
    double axis_A = 0.0;
    std::uint32_t counts_per_rev = 0;
};

/// Corrupts what a controller sees of its machine from the first call on.
class SignalCorruption {
  public:
    SignalCorruption(SignalFault fault, const Rated& rated, std::uint64_t seed)
        : fault_(fault), rated_(rated), random_(seed) {}

    /// `before`: the last good sample. `since_s`: how long it lasts already.
    void corrupt(hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before, double since_s);

  private:
    struct Moment {
        double since_s = 0.0;
        hal::DriveSample sample{};
        hal::ProgramStatus program{};
    };

    void corrupt_currents(hal::DriveSample& sample, const hal::DriveSample& before, double since_s);
    void corrupt_single_samples(hal::DriveSample& sample, double since_s);
    void corrupt_velocities(hal::DriveSample& sample, const hal::DriveSample& before) const;
    void corrupt_encoder(hal::DriveSample& sample, const hal::DriveSample& before, double since_s);
    void corrupt_program(hal::ProgramStatus& program);
    void corrupt_time(hal::DriveSample& sample, const hal::DriveSample& before);
    void corrupt_by_past(hal::DriveSample& sample, hal::ProgramStatus& program, double since_s);
    [[nodiscard]] bool every_second_time() { return (++calls_ & 1U) != 0; }

    SignalFault fault_;
    Rated rated_;
    std::mt19937_64 random_;
    std::deque<Moment> past_;                 // the youngest last
    std::optional<hal::DriveSample> held_{};  // of an encoder that stands
    std::optional<hal::ProgramStatus> first_program_{};
    double smoothed_A_ = 0.0;
    unsigned calls_ = 0;
};

}  // namespace millforce::faults
