// SPDX-License-Identifier: Apache-2.0
#include "stm32_h405/analogue_controller.hpp"

#include "firmware/path_speed.hpp"
#include "firmware/tool_checksum.hpp"
#include "hal/cia301.hpp"
#include "hal/tick_watch.hpp"

namespace millforce::stm32_h405 {

namespace cia301 = hal::cia301;
using emergency::error_code;
using emergency::Reason;

namespace {

constexpr std::uint32_t can_patience = 100'000;  // polls until the CAN controller counts as absent

/// Of less than an hour: from 32 bits, since from 64 a float needs the library's own arithmetic.
float seconds(std::uint64_t microseconds) {
    return static_cast<float>(static_cast<std::uint32_t>(microseconds)) * 1e-6F;
}

}  // namespace

AnalogueController::AnalogueController(const Peripherals& p, const Wiring& wiring)
    : wiring_(wiring),
      pwr_(p.pwr),
      drives_(p, wiring_),
      can_(p.can),
      watchdog_(p.watchdog),
      sender_(wiring.feed_override),
      program_(wiring.program),
      tool_(program_status::tool_frame_id(wiring.program.id)),
      speed_(program_status::speed_frame_id(wiring.program.id)),
      position_(program_status::position_frame_id(wiring.program.id)),
      emergencies_(wiring.feed_override.node_id),
      filters_{{{wiring.program.id, hal::largest_standard_can_id},
                {program_status::tool_frame_id(wiring.program.id), hal::largest_standard_can_id},
                {program_status::speed_frame_id(wiring.program.id), hal::largest_standard_can_id},
                {program_status::position_frame_id(wiring.program.id), hal::largest_standard_can_id},
                {way_window::way_frame_id(wiring.feed_override.node_id), hal::largest_standard_can_id}}} {}

void AnalogueController::start(const StartReport& report, const firmware::Parameters<float>& parameters,
                               std::uint64_t now_us, const Tools* tools) {
    report_start(report);
    drives_.start();
    can_.start(wiring_.bit_rate, filters_);
    complete_us_ = now_us;
    next_tick_us_ = now_us + period_us_;  // the first scans are complete by then
    if (report.parameters != firmware::BlockError::none) {
        output_.fault = static_cast<std::uint8_t>(control::Fault::bad_configuration);
        output_.state = static_cast<std::uint8_t>(control::CutState::fault);
        return;
    }
    parameters_ = &parameters;
    tick_.emplace(parameters, tools);
    if (has_position()) {
        way_.emplace(parameters, firmware::tool_checksum(parameters.tool), wiring_.feed_override.node_id);
    }
    largest_ratio_ = parameters.machine.cnc.override_max;
    period_us_ = static_cast<std::uint32_t>(1e6F / parameters.machine.cnc.sample_rate_hz);
    drives_.watch_spindle(parameters.machine.encoder_counts_per_rev);
    watchdog_.start(tools != nullptr ? wiring_.watchdog_with_tools_us : wiring_.watchdog_us);
}

bool AnalogueController::has_position() const {
    return program_status::position_frame_id(wiring_.program.id) != 0;
}

void AnalogueController::report_start(const StartReport& report) {
    emergencies_.report_start(report.cause);
    if (report.had_processor_fault) {
        emergencies_.report(Reason::processor_fault, error_code(Reason::processor_fault), report.fault_program_counter);
    }
    emergencies_.set(Reason::no_parameters, report.parameters != firmware::BlockError::none,
                     static_cast<std::uint32_t>(report.parameters));
}

void AnalogueController::poll(std::uint64_t now_us) {
    can_.poll(can_patience);
    receive_frames(now_us);
    if (now_us >= next_tick_us_) {
        const bool is_late = now_us >= next_tick_us_ + period_us_;
        late_ticks_ += is_late ? 1U : 0U;
        next_tick_us_ = is_late ? now_us + period_us_ : next_tick_us_ + period_us_;
        run_tick(now_us);
    }
    sender_.poll(now_us);
    send_frames();
    if (tick_ && tick_->work_due()) {
        tick_->work();
    }
}

void AnalogueController::receive_frames(std::uint64_t now_us) {
    hal::CanFrame frame;
    while (can_.receive(frame)) {
        program_.on_frame(frame, now_us);
        tool_.on_frame(frame, now_us);
        speed_.on_frame(frame, now_us);
        position_.on_frame(frame, now_us);
        if (way_) {
            way_->on_frame(frame);
        }
    }
    if (can_.is_on_bus() && can_.health().bus_offs != bus_offs_) {
        bus_offs_ = can_.health().bus_offs;
        emergencies_.report(Reason::bus_was_off, error_code(Reason::bus_was_off), bus_offs_);
    }
}

void AnalogueController::send_frames() {
    hal::CanFrame frame;
    // The boot-up comes before any EMCY, the newest override before both once it runs: the sender's order first.
    while (can_.has_room() &&
           (sender_.take_frame(frame) || emergencies_.take_frame(frame) || (way_ && way_->take_frame(frame)))) {
        can_.send(frame);
    }
}

void AnalogueController::run_tick(std::uint64_t now_us) {
    drives_.poll(now_us);
    (void)drives_.take_sample(sample_);  // there is one after each poll()
    const bool is_supply_low = stm32::supply_is_low(pwr_);
    emergencies_.set(Reason::supply_low, is_supply_low, 0);
    hal::FeedOverride output = step(now_us);
    if (is_healthy(output)) {
        watchdog_.feed();
    } else {
        output.hold = true;
    }
    output.hold = output.hold || is_supply_low;
    emergencies_.set(Reason::tick_fault, tick_ && output.fault != 0, output.fault);
    emergencies_.follow(Reason::tool_unknown, tick_ && !tick_->is_tool_known(), tool_.number(now_us));
    output_ = output;
    sender_.update(output_, now_us);
}

bool AnalogueController::is_at_rest() const {
    return sample_.present == drives_.complete() && hal::axes_rest(sample_.axis_velocity_mm_s);
}

hal::FeedOverride AnalogueController::step(std::uint64_t now_us) {
    if (!tick_) {
        hal::FeedOverride output = output_;
        ++output.heartbeat;
        return output;
    }
    const bool is_complete = sample_.present == drives_.complete() && !stm32::supply_is_low(pwr_);
    emergencies_.set(Reason::inputs_missing, sample_.present != drives_.complete(), sample_.present);
    const hal::ProgramStatus program = program_at(now_us);
    if (program_.take_reset() && sample_.present == drives_.complete() &&
        tick_->may_reset(sample_.axis_velocity_mm_s)) {
        tick_->reset_fault();
    }
    if (is_complete || was_tool_changed_) {
        complete_us_ = now_us;
    }
    was_tool_changed_ = false;
    if (is_complete) {
        follow_tool(now_us);
    }
    if (is_complete && !was_tool_changed_) {
        return step_on_sample(program);
    }
    return tick_->step_without_sample(seconds(now_us - complete_us_), seconds(period_us_), program);
}

hal::ProgramStatus AnalogueController::program_at(std::uint64_t now_us) const {
    hal::ProgramStatus program = program_.program(now_us);
    const program_status::ProgramPosition position = position_.position(now_us, firmware::path_speed_mm_s(sample_));
    program.line = position.line;
    program.distance_to_go_mm = position.distance_to_go_mm;
    program.commanded_speed_rad_s = speed_.speed_rad_s(now_us);
    return program;
}

void AnalogueController::follow_tool(std::uint64_t now_us) {
    was_tool_changed_ = tick_->follow_tool(tool_.number(now_us), is_at_rest());
    if (was_tool_changed_ && way_) {
        way_->change_tool(firmware::AlongPath(*parameters_), firmware::tool_checksum(parameters_->tool));
    }
}

hal::FeedOverride AnalogueController::step_on_sample(const hal::ProgramStatus& program) {
    tick_->take(sample_);
    if (way_ && tick_->is_tool_known()) {
        way_->look_ahead_of(tick_->of_tool(), program);
    }
    return tick_->answer(program);
}

bool AnalogueController::is_healthy(const hal::FeedOverride& output) const {
    return tick_.has_value() && output.heartbeat == output_.heartbeat + 1U &&
           hal::is_within_limits(output, largest_ratio_);
}

bool AnalogueController::send_final_frames(Reason reason, std::uint32_t detail) {
    output_.hold = true;
    ++output_.heartbeat;
    hal::CanFrame heartbeat;
    heartbeat.id = cia301::cob_id::heartbeat + wiring_.feed_override.node_id;
    heartbeat.length = 1;
    heartbeat.data[0] = byte_of(cia301::NmtState::stopped);
    return can_.send(override_frame::encode(output_, wiring_.feed_override.id)) && can_.send(heartbeat) &&
           can_.send(emergencies_.frame_of(reason, error_code(reason), detail));
}

}  // namespace millforce::stm32_h405
