// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
    x_tenfold,  ///< current × 10
    x_weak,     ///< × 0.3
    x_reversed,
    x_drifts,       ///< +0.5 A/s
    x_drifts_down,  ///< −0.5 A/s
    x_high,         ///< an offset of +10 % of rated current
    x_frozen,
    x_dead,
    y_tenfold,
    y_weak,
    y_reversed,
    y_drifts,
    y_frozen,
    y_dead,
    x_and_y_swapped,   ///< currents
    velocities_huge,   ///< × 10⁶
    velocities_small,  ///< × 0.1
    velocities_zero,
    velocities_frozen,
    velocities_reversed,
    velocities_swapped,  ///< x and y
    encoder_double,      ///< counts twice
    encoder_half,
    encoder_loses,     ///< 3 % of the counts
    encoder_reversed,  ///< the index, too
    index_lost,        ///< no further index pulse
    encoder_frozen,
    encoder_absent,
    not_a_number,  ///< all currents and velocities
    rapid_stuck,
    feed_told_low,  ///< F × 0.1
    feed_told_high,
    feed_not_a_number,
    operator_told_high,  ///< override × 3
    operator_not_a_number,
    hold_stuck,
    time_frozen,
    time_backwards,
    time_double,  ///< a clock that runs twice as fast
    time_half,
};
inline constexpr int signal_faults = static_cast<int>(SignalFault::time_half) + 1;

const char* name_of(SignalFault fault);

/// Corrupts what a controller sees of its machine from the first call on.
class SignalCorruption {
  public:
    SignalCorruption(SignalFault fault, double spindle_rated_A, double axis_rated_A, std::uint64_t seed)
        : fault_(fault), spindle_rated_A_(spindle_rated_A), axis_rated_A_(axis_rated_A), random_(seed) {}

    /// `before`: the last good sample. `since_s`: how long it lasts already.
    void corrupt(hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before, double since_s);

  private:
    void corrupt_currents(hal::DriveSample& sample, const hal::DriveSample& before, double since_s);
    void corrupt_velocities(hal::DriveSample& sample, const hal::DriveSample& before) const;
    void corrupt_encoder(hal::DriveSample& sample, const hal::DriveSample& before) const;
    void corrupt_program(hal::ProgramStatus& program) const;
    void corrupt_time(hal::DriveSample& sample, const hal::DriveSample& before) const;

    SignalFault fault_;
    double spindle_rated_A_;
    double axis_rated_A_;
    std::mt19937_64 random_;
};

}  // namespace millforce::faults
