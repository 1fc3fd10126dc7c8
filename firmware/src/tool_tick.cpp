// SPDX-License-Identifier: Apache-2.0
#include "firmware/tool_tick.hpp"

namespace millforce::firmware {

ToolTick::ToolTick(const Parameters<float>& parameters, const ToolSource* tools)
    : tools_(tools),
      limits_(controller_parameters(parameters)),
      tick_(parameters),
      machine_(tick_.machine_knowledge()) {}

void ToolTick::follow_tool(std::uint32_t number, bool axes_rest) {
    const bool is_first = !has_begun_;
    has_begun_ = true;
    told_ = number;
    if (tools_ != nullptr && number != number_ && (is_first || (axes_rest && may_change_to(number)))) {
        change_to(number);
    }
}

/// A dwell in the workpiece ends in `exit`, and a number that was lost must not free the feed there.
bool ToolTick::may_change_to(std::uint32_t number) const {
    const control::ControlOutput<float>& last = tick_.control();
    const bool is_out = tools_->has(number) ? !control::is_cutting(last.state) : last.state == control::CutState::air;
    return last.fault == control::Fault::none && is_out;
}

void ToolTick::change_to(std::uint32_t number) {
    const std::uint32_t next = tools_->has(number) ? number : 0;
    if (next == number_) {
        return;  // none as before
    }
    if (number_ != 0) {
        machine_ = tick_.machine_knowledge();
    }
    tools_->set_up(next, tick_);
    tick_.set_machine_knowledge(machine_);
    number_ = next;
}

void ToolTick::take(const hal::DriveSample& sample) {
    const float passed_s = elapsed_s(sample.time_us);
    if (is_tool_known()) {
        tick_.take(sample);
        return;
    }
    hal::DriveSample time_alone;
    time_alone.time_us = sample.time_us;
    tick_.take(time_alone);
    machine_.drives.predict(passed_s);
}

/// Since the last sample; 0 for the first one and where the clock went backwards.
float ToolTick::elapsed_s(std::uint32_t time_us) {
    const auto elapsed_us = static_cast<std::int32_t>(time_us - time_us_);
    const bool is_known = has_time_ && elapsed_us > 0;
    has_time_ = true;
    time_us_ = time_us;
    return is_known ? static_cast<float>(elapsed_us) * 1e-6F : 0.0F;
}

hal::FeedOverride ToolTick::answer(const hal::ProgramStatus& program) {
    return passed_on(tick_.answer(program), program);
}

hal::FeedOverride ToolTick::step_without_sample(float silent_s, float dt_s, const hal::ProgramStatus& program) {
    return passed_on(tick_.step_without_sample(silent_s, dt_s, program), program);
}

/// Its heartbeat goes on where the tick's begins again.
hal::FeedOverride ToolTick::passed_on(hal::FeedOverride output, const hal::ProgramStatus& program) {
    if (!is_tool_known() && output.fault == static_cast<std::uint8_t>(control::Fault::none)) {
        output.ratio = control::bounded(limits_, program.operator_override);
        output.hold = program.feed_hold;
    }
    output.heartbeat = ++heartbeat_;
    return output;
}

}  // namespace millforce::firmware
