// SPDX-License-Identifier: Apache-2.0
#include "zcu102/bus_controller.hpp"

#include "hal/tick_watch.hpp"

namespace millforce::zcu102 {

using emergency::Reason;

namespace {
constexpr std::uint64_t off_the_bus_us = 100'000;
constexpr std::uint64_t still_us = 5'000;

firmware::WaySource<float>* way_of(std::optional<firmware::WayOfTools>& way,
                                   const firmware::CanControllerSettings& settings,
                                   const firmware::Parameters<float>& parameters, const firmware::ReadyTools* tools) {
    return program_status::position_frame_id(settings.program.id) != 0
               ? &way.emplace(parameters, settings.feed_override.node_id, tools)
               : nullptr;
}

}  // namespace

BusController::BusController(const Peripherals& peripherals, const firmware::CanControllerSettings& settings,
                             const firmware::Parameters<float>& parameters, const firmware::ReadyTools* tools)
    : can_(peripherals.can),
      watchdog_(peripherals.watchdog, peripherals.errors),
      emergencies_(settings.feed_override.node_id),
      controller_(settings, parameters, nullptr, tools, way_of(way_, settings, parameters, tools)),
      largest_ratio_(parameters.machine.cnc.override_max) {}

void BusController::start(const zynqmp::CanBitTiming& timing, hal::ResetCause cause) {
    emergencies_.report_start(cause);
    timing_ = timing;
    can_.start(timing);
}

void BusController::rejoin_after_bus_off(std::uint64_t now_us) {
    if (can_.state() != zynqmp::CanState::bus_off) {
        on_bus_us_ = now_us;
    } else if (now_us >= on_bus_us_ + off_the_bus_us) {
        can_.start(timing_);
    }
}

void BusController::poll(std::uint64_t now_us) {
    can_.poll();
    rejoin_after_bus_off(now_us);
    exchange_frames(now_us);
    if (controller_.work_due()) {
        controller_.work();
    }
    guard_ticks(now_us);
}

void BusController::exchange_frames(std::uint64_t now_us) {
    hal::CanFrame frame;
    if (can_.receive(frame)) {
        heard_us_ = now_us;
        controller_.on_frame(frame, now_us, false);
    }
    controller_.poll(now_us);
    while (controller_.take_frame(frame)) {
        if (can_.send(frame)) {
            heard_us_ = now_us;
            has_sent_ = true;
            controller_.on_frame(frame, now_us, true);
        }
    }
    report_what_is_wrong();
    while (has_sent_ && can_.has_room() && emergencies_.take_frame(frame)) {
        can_.send(frame);
    }
}

void BusController::guard_ticks(std::uint64_t now_us) {
    const bool is_sound = hal::is_within_limits(controller_.output(), largest_ratio_);
    controller_.hold_from_outside(!is_sound);
    if (is_sound && controller_.ticks() != healthy_ticks_) {
        healthy_ticks_ = controller_.ticks();
        feed_watchdog();
    } else if (now_us >= heard_us_ + still_us) {
        watchdog_.feed();
    }
}

void BusController::feed_watchdog() {
    if (watchdog_.is_started()) {
        watchdog_.feed();
    } else {
        watchdog_.start(watchdog_us, watchdog_clock_MHz);
    }
}

void BusController::report_what_is_wrong() {
    const hal::FeedOverride& output = controller_.output();
    const bool lacks_something = controller_.conditions().has(firmware::Condition::input_incomplete);
    emergencies_.set(Reason::inputs_missing, lacks_something && controller_.ticks() != 0, controller_.sample().present);
    emergencies_.follow(Reason::tool_unknown, controller_.conditions().has(firmware::Condition::tool_unknown),
                        controller_.reported_tool());
    emergencies_.set(Reason::tick_fault, output.fault != 0, output.fault);
    if (can_.is_on_bus() && can_.health().bus_offs != bus_offs_) {
        bus_offs_ = can_.health().bus_offs;
        emergencies_.report(Reason::bus_was_off, emergency::error_code(Reason::bus_was_off), bus_offs_);
    }
}

}  // namespace millforce::zcu102
