// SPDX-License-Identifier: Apache-2.0
#include "firmware_link/link_controller.hpp"

#include <algorithm>
#include <limits>

namespace millforce::firmware {

namespace {

constexpr std::uint32_t gap_us = 10'000;
constexpr float no_estimate = std::numeric_limits<float>::quiet_NaN();

hal::ProgramStatus program_of(const local_link::SampleMessage& m) {
    hal::ProgramStatus program;
    program.programmed_feed_mm_s = m.programmed_feed_mm_s;
    program.operator_override = m.operator_limit;
    program.rapid = m.rapid;
    program.feed_hold = m.feed_hold;
    program.line = m.line;
    program.distance_to_go_mm = m.distance_to_go_mm;
    program.commanded_speed_rad_s = m.commanded_speed_rad_s;
    return program;
}

float value_of(const estimation::Measurement<float>& measurement) {
    return measurement.valid ? measurement.value : no_estimate;
}

}  // namespace

MachineParameters<float> capped(const MachineParameters<float>& machine, float largest_override) {
    MachineParameters<float> capped = machine;
    capped.cnc.override_max = std::min(machine.cnc.override_max, largest_override);
    return capped;
}

LinkController::LinkController(const Parameters<float>& parameters, float largest_override, WaySource<float>* way,
                               const ToolSource* tools)
    : tick_({capped(parameters.machine, largest_override), parameters.tool}, tools),
      largest_override_(largest_override),
      way_(way) {}

local_link::MessageError LinkController::on_message(std::span<const std::uint8_t> bytes,
                                                    local_link::OverrideBytes& answer) {
    local_link::SampleMessage message;
    if (const auto error = decode(bytes, message); error != local_link::MessageError::none) {
        return error;
    }
    program_ = program_of(message);
    bridge_gap(message.time_us, program_);
    reset_where_asked(message);
    finish_work(tick_);  // what was not done in time
    if (tick_.follow_tool(message.tool, hal::axes_rest(message.axis_velocity_mm_s)) && way_ != nullptr) {
        way_->set_tool(tick_.tool());
    }
    drives_.on_message(message);
    (void)drives_.take_sample(sample_);  // each message is one
    tick_.take(sample_);
    finish_estimate(tick_);
    if (way_ != nullptr && tick_.is_tool_known()) {
        way_->look_ahead(tick_.of_tool(), program_);
    }
    output_ = tick_.answer(program_);
    answer = encode(answer_to(message.sequence));
    return local_link::MessageError::none;
}

void LinkController::bridge_gap(std::uint32_t time_us, const hal::ProgramStatus& program) {
    const auto elapsed_us = static_cast<std::int32_t>(time_us - time_us_);
    if (has_time_ && elapsed_us > static_cast<std::int32_t>(gap_us)) {
        const float silent_s = static_cast<float>(elapsed_us) * 1e-6F;
        tick_.step_without_sample(silent_s, silent_s, program);
    }
    has_time_ = true;
    time_us_ = time_us;
}

void LinkController::reset_where_asked(const local_link::SampleMessage& message) {
    const bool is_asked = message.reset && !was_reset_;
    was_reset_ = message.reset;
    if (is_asked && tick_.may_reset(message.axis_velocity_mm_s)) {
        tick_.reset_fault();
    }
}

local_link::OverrideMessage LinkController::answer_to(std::uint32_t sequence) const {
    const ForceControlTick<float>& tick = tick_.of_tool();
    const auto& estimate = tick.estimate();
    const auto engagement = tick.engagement();
    local_link::OverrideMessage m;
    m.sequence = sequence;
    m.heartbeat = output_.heartbeat;
    m.ratio = std::min(output_.ratio, largest_override_);
    m.hold = is_held();
    m.tool_unknown = !tick_.is_tool_known();
    m.state = output_.state;
    m.fault = output_.fault;
    m.limit = static_cast<std::uint8_t>(tick.control().limit);
    m.tangential_N = value_of(estimate.tangential_N);
    m.feed_N = value_of(estimate.feed_N);
    const bool arc_is_known = engagement.immersion_valid && !estimate.tooth_force_is_bound;
    m.tooth_force_N = arc_is_known ? value_of(estimate.tooth_force_N) : no_estimate;
    m.radial_immersion = engagement.immersion_valid ? engagement.radial_immersion : no_estimate;
    m.radial_immersion_sd = engagement.immersion_valid ? engagement.radial_immersion_sd : no_estimate;
    m.axial_depth_mm = engagement.depth_valid ? engagement.axial_depth_mm : no_estimate;
    m.axial_depth_sd_mm = engagement.depth_valid ? engagement.axial_depth_sd_mm : no_estimate;
    return m;
}

}  // namespace millforce::firmware
