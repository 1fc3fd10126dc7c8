// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/tick.hpp"
#include "firmware/tool_source.hpp"

/// The tick (tick.hpp) of the tool in the spindle. The CNC sends the tool's number; a source of tools has its tick.
///
///     tick.follow_tool(number, axes_rest);     // before each sample
///     tick.take(sample);                       // and on as with ForceControlTick
///
/// The tool is changed where all axes rest and the forces show no cut. What belongs to the tool then begins again; what
/// was learnt of the machine in air stays. The first number of a run is taken in motion, too.
///
/// A number that changes in motion, whatever it is, waits for the axes to rest: no spindle changes its tool in a cut,
/// and the override does not jump up in one. Until then it is by the limits of the last tool, and never above the
/// operator's.
///
/// The tool is not known where the axes rest in the state `air` and the number is 0 or not in the source: a dwell in
/// the workpiece is not enough. Then the override is the operator's, as with monitor_only: never one by the limits of
/// the last tool. The tick sees the samples' time alone: it estimates and learns nothing.
///
/// A fault comes first: it holds the feed until its reset, and the tool changes after that.
///
/// Without a source it is the tick of one tool, and numbers mean nothing. No heap. One thread. Cost: that of the
/// tick; a change, what the source takes. Bodies: tool_tick_impl.hpp.

namespace millforce::firmware {

/// `Tick`: a ForceControlTick in float. `Source`: has() and set_up() as ToolSource.
template <typename Tick, typename Source>
class ToolTickOf {
  public:
    /// `parameters.tool`: without a source the tool; with one, any tool. `tools` outlives this, and its machine is that
    /// of `parameters`.
    explicit ToolTickOf(const Parameters<float>& parameters, const Source* tools = nullptr);

    /// `number`: 0 where the CNC has sent none. Returns whether the tick is another one now; what was due of the last
    /// sample is dropped then.
    bool follow_tool(std::uint32_t number, bool axes_rest);

    void take(const hal::DriveSample& sample);
    hal::FeedOverride answer(const hal::ProgramStatus& program);
    /// take() and answer() at once.
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program);
    hal::FeedOverride step_without_sample(float silent_s, float dt_s, const hal::ProgramStatus& program);
    void reset_fault() { tick_.reset_fault(); }
    /// Whether a fault may be reset: no axis moves. In a cut that is held the forces shake the axes, and the mean of a
    /// revolution counts.
    [[nodiscard]] bool may_reset(const std::array<float, hal::axis_count>& velocity_mm_s) const {
        return hal::axes_rest(velocity_mm_s) || tick_.axes_rest();
    }
    [[nodiscard]] bool estimate_due() const { return tick_.estimate_due(); }
    [[nodiscard]] bool work_due() const { return tick_.work_due(); }
    void work() { tick_.work(); }

    [[nodiscard]] bool is_tool_known() const { return tools_ == nullptr || number_ != 0; }
    /// The CNC sends another number than that of the tool that the override is for.
    [[nodiscard]] bool is_change_due() const { return tools_ != nullptr && number_ != 0 && number_ != reported_; }
    /// Number of the tool that the override is for; 0: without a source, or not known.
    [[nodiscard]] std::uint32_t tool() const { return number_; }

    [[nodiscard]] Tick& of_tool() { return tick_; }
    [[nodiscard]] const Tick& of_tool() const { return tick_; }

  private:
    [[nodiscard]] bool may_change_to(std::uint32_t number) const;
    bool change_to(std::uint32_t number);
    [[nodiscard]] float elapsed_s(std::uint32_t time_us);
    hal::FeedOverride passed_on(hal::FeedOverride output, const hal::ProgramStatus& program);

    const Source* tools_;
    Tick tick_;
    bool has_begun_ = false;
    std::uint32_t reported_ = 0;
    std::uint32_t number_ = 0;  // of the tick's tool; 0: none
    bool has_time_ = false;
    std::uint32_t time_us_ = 0;  // of the newest sample
    std::uint32_t heartbeat_ = 0;
};

/// On a computer.
using ToolTick = ToolTickOf<ForceControlTick<float>, ToolSource>;

}  // namespace millforce::firmware
