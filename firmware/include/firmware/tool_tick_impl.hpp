// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/tool_tick.hpp"

namespace millforce::firmware {

template <typename Tick, typename Source>
ToolTickOf<Tick, Source>::ToolTickOf(const Parameters<float>& parameters, const Source* tools)
    : tools_(tools), tick_(parameters) {}

template <typename Tick, typename Source>
bool ToolTickOf<Tick, Source>::follow_tool(std::uint32_t number, bool axes_rest) {
    const bool is_first = !has_begun_;
    has_begun_ = true;
    reported_ = number;
    const bool is_other = tools_ != nullptr && number != number_;
    return is_other && (is_first || (axes_rest && may_change_to(number))) && change_to(number);
}

/// A dwell in the workpiece ends in `exit`, and a number that was lost must not free the feed there.
template <typename Tick, typename Source>
bool ToolTickOf<Tick, Source>::may_change_to(std::uint32_t number) const {
    const control::ControlOutput<float>& last = tick_.control();
    const bool is_out = tools_->has(number) ? !control::is_cutting(last.state) : last.state == control::CutState::air;
    return last.fault == control::Fault::none && is_out;
}

template <typename Tick, typename Source>
bool ToolTickOf<Tick, Source>::change_to(std::uint32_t number) {
    const std::uint32_t next = tools_->has(number) ? number : 0;
    if (next == number_) {
        return false;  // none as before
    }
    const MachineKnowledge<float> learnt = tick_.machine_knowledge();
    tools_->set_up(next, tick_);
    tick_.set_machine_knowledge(learnt);
    number_ = next;
    return true;
}

template <typename Tick, typename Source>
void ToolTickOf<Tick, Source>::take(const hal::DriveSample& sample) {
    const float passed_s = elapsed_s(sample.time_us);
    if (is_tool_known()) {
        tick_.take(sample);
        return;
    }
    hal::DriveSample time_alone;
    time_alone.time_us = sample.time_us;
    tick_.take(time_alone);
    tick_.let_machine_drift(passed_s);
}

/// Since the last sample; 0 for the first one and where the clock went backwards.
template <typename Tick, typename Source>
float ToolTickOf<Tick, Source>::elapsed_s(std::uint32_t time_us) {
    const auto elapsed_us = static_cast<std::int32_t>(time_us - time_us_);
    const bool is_known = has_time_ && elapsed_us > 0;
    has_time_ = true;
    time_us_ = time_us;
    return is_known ? static_cast<float>(elapsed_us) * 1e-6F : 0.0F;
}

template <typename Tick, typename Source>
hal::FeedOverride ToolTickOf<Tick, Source>::answer(const hal::ProgramStatus& program) {
    return passed_on(tick_.answer(program), program);
}

template <typename Tick, typename Source>
hal::FeedOverride ToolTickOf<Tick, Source>::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    take(sample);
    return answer(program);
}

template <typename Tick, typename Source>
hal::FeedOverride ToolTickOf<Tick, Source>::step_without_sample(float silent_s, float dt_s,
                                                                const hal::ProgramStatus& program) {
    return passed_on(tick_.step_without_sample(silent_s, dt_s, program), program);
}

/// Its heartbeat goes on where the tick's begins again.
template <typename Tick, typename Source>
hal::FeedOverride ToolTickOf<Tick, Source>::passed_on(hal::FeedOverride output, const hal::ProgramStatus& program) {
    if (!is_tool_known() && output.fault == static_cast<std::uint8_t>(control::Fault::none)) {
        output.ratio = tick_.operators_override(program);
        output.hold = program.feed_hold;
    }
    output.heartbeat = ++heartbeat_;
    return output;
}

}  // namespace millforce::firmware
