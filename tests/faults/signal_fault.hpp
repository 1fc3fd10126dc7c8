// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"
#include "loop/override_source.hpp"

/// Signals that go wrong in the middle of a part, between the machine and its controller.

namespace millforce::faults {

enum class SignalFault : std::uint8_t {
    none,
    spindle_weak,       ///< current × 0.3
    spindle_strong,     ///< current × 3
    spindle_saturated,  ///< current never above what it was at the fault's begin
    spindle_drifts,     ///< −0.5 A/s
    spindle_frozen,     ///< the last value for good
    spindle_dead,       ///< 0 A
    spindle_reversed,
    spindle_noisy,  ///< 10 % of rated current, normally distributed
    spindle_absent,
    x_tenfold,  ///< current × 10
    x_reversed,
    x_drifts,  ///< +0.5 A/s
    x_frozen,
    x_dead,
    x_and_y_swapped,   ///< currents
    velocities_huge,   ///< × 10⁶
    velocities_small,  ///< × 0.1
    encoder_double,    ///< counts twice
    encoder_half,
    encoder_frozen,
    encoder_absent,
    not_a_number,  ///< all currents and velocities
    rapid_stuck,
    feed_told_low,  ///< F × 0.1
    feed_told_high,
    time_frozen,
    time_backwards,
};
inline constexpr int signal_faults = static_cast<int>(SignalFault::time_backwards) + 1;

const char* name_of(SignalFault fault);

/// Stands before a controller and corrupts what it sees from `begins_s` on. Time is the samples' own.
class FaultyMachine : public sim::OverrideSource {
  public:
    struct Settings {
        SignalFault fault = SignalFault::none;
        double begins_s = 0.0;  ///< after the first sample
        double spindle_rated_A = 1.0;
        std::uint64_t seed = 1;
    };

    FaultyMachine(sim::OverrideSource& controller, const Settings& settings)
        : controller_(controller), settings_(settings), random_(settings.seed) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(sim::TracePoint& point) const override { controller_.describe(point); }

    /// What the controller did about it. It has reacted where it holds the feed, or has a fault.
    struct Reaction {
        bool has_begun = false;  ///< the part was not over before
        bool has_reacted = false;
        double after_s = 0.0;
        std::uint8_t fault = 0;  ///< control::Fault
    };
    [[nodiscard]] const Reaction& reaction() const { return reaction_; }

  private:
    void corrupt(hal::DriveSample& sample, hal::ProgramStatus& program);
    void corrupt_spindle(hal::DriveSample& sample);
    void corrupt_axes(hal::DriveSample& sample);
    void corrupt_encoder(hal::DriveSample& sample);
    void corrupt_program(hal::ProgramStatus& program);
    void corrupt_time(hal::DriveSample& sample);

    sim::OverrideSource& controller_;
    Settings settings_;
    std::mt19937_64 random_;
    bool has_first_ = false;
    std::uint32_t last_us_ = 0;
    double time_s_ = 0.0;
    double since_s_ = 0.0;
    hal::DriveSample before_{};  ///< the last good one
    Reaction reaction_{};
};

}  // namespace millforce::faults
