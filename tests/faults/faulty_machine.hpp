// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"
#include "loop/override_source.hpp"

/// A machine on which something goes wrong while a part is milled, and what its controller does about it.

namespace millforce::faults {

/// What the CNC got from the controller once the fault had begun. The controller has reacted where it holds the feed,
/// or has a fault.
struct Reaction {
    bool has_begun = false;  ///< the part was not over before
    bool has_reacted = false;
    double after_s = 0.0;
    std::uint8_t found_by = 0;      ///< control::Fault at that moment; none: a hold alone
    std::uint8_t fault = 0;         ///< control::Fault
    bool is_beyond_bound = false;   ///< at any time: an override that is not a number within [0, override_max]
    bool ran_in_fault = false;      ///< a fault was latched, and the feed free
    bool rose_blind = false;        ///< the free override of a feed rose later than detection_s after the begin
    bool stopped_silently = false;  ///< the axes stood for a second in a feed without a hold, a fault or the operator
    double held_s = 0.0;            ///< how long the feed is held at the end
    bool is_repaired = false;       ///< held for held_for_good_s, then OnPath::repair and reset
};

/// What is held for so long is over, or is repaired; then the operator resets, and a second and a third time where that
/// does not help.
inline constexpr double held_for_good_s = 1.0;
inline constexpr double reset_after_s = 0.5;
inline constexpr int most_resets = 3;

/// An invalid signal is to be noticed by then.
inline constexpr double detection_s = 0.5;

/// What the path between machine and controller adds: each may be empty.
struct OnPath {
    std::function<void()> begin{};              ///< once, at the fault's begin
    std::function<void()> repair{};             ///< ends the fault; empty: nobody does
    std::function<void(bool pressed)> reset{};  ///< reset_after_s later, and half of that after it was pressed
};

/// Stands between the plant and a controller. Time is the samples' own.
class FaultyMachine : public sim::OverrideSource {
  public:
    /// Alters what the controller sees, at each sample from the fault's begin on.
    using Corrupt = std::function<void(hal::DriveSample& sample, hal::ProgramStatus& program,
                                       const hal::DriveSample& before, double since_s)>;
    struct Settings {
        double begins_s = 0.0;  ///< after the first sample
        double override_max = 1.0;
        OnPath on_path{};
        Corrupt corrupt{};          ///< may be empty
        bool leaves_blind = false;  ///< the fault leaves nothing to go by: the override must not rise
    };

    FaultyMachine(sim::OverrideSource& controller, Settings settings)
        : controller_(controller), settings_(std::move(settings)) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(sim::TracePoint& point) const override { controller_.describe(point); }
    [[nodiscard]] bool is_ready() const override { return controller_.is_ready(); }
    [[nodiscard]] PlantSteps plant_steps(const PlantSteps& usual) override { return controller_.plant_steps(usual); }

    [[nodiscard]] const Reaction& reaction() const { return reaction_; }
    /// Held, and nobody will repair it.
    [[nodiscard]] bool is_over() const { return !waits_for_reset() && reaction_.held_s >= held_for_good_s; }

  private:
    [[nodiscard]] hal::FeedOverride step_with_fault(const hal::DriveSample& sample, const hal::ProgramStatus& program);
    void repair_where_held();
    void press_reset();
    [[nodiscard]] bool waits_for_reset() const { return resets_left_ > 0; }
    void judge(const hal::FeedOverride& output);
    void judge_rise(const hal::FeedOverride& output, double since_s);
    void judge_stop(const hal::FeedOverride& output, const hal::ProgramStatus& told);

    sim::OverrideSource& controller_;
    Settings settings_;
    bool has_first_ = false;
    std::uint32_t last_us_ = 0;
    double time_s_ = 0.0;
    double dt_s_ = 0.0;
    hal::DriveSample before_{};  ///< the last good one
    double blind_ratio_ = -1.0;  ///< the lowest free override later than detection_s
    double stopped_s_ = 0.0;     ///< without a word
    int resets_left_ = 0;
    double since_reset_s_ = 0.0;  ///< or since the repair
    bool is_pressed_ = false;
    Reaction reaction_{};
};

}  // namespace millforce::faults
