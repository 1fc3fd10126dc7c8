// SPDX-License-Identifier: Apache-2.0
#include "telemetry/event_watch.hpp"

#include <fmt/format.h>

#include "control/cut_state.hpp"

namespace millforce::host {

namespace {

using Report = EventWatch::Report;

bool is_new_run(const TelemetrySample& last, const TelemetrySample& now) {
    return now.tick.feed_override.heartbeat < last.tick.feed_override.heartbeat;
}

void compare_faults(const TelemetrySample& last, const Telemetry& now, const Report& report) {
    const std::uint8_t fault = now.sample.tick.feed_override.fault;
    if (fault == last.tick.feed_override.fault) {
        return;
    }
    const bool is_over = fault == static_cast<std::uint8_t>(control::Fault::none);
    report({now.unix_us, is_over ? EventLevel::info : EventLevel::fault,
            is_over ? "fault reset" : fmt::format("fault: {}", control::name(static_cast<control::Fault>(fault)))});
}

void compare_holds(const TelemetrySample& last, const Telemetry& now, const Report& report) {
    if (now.sample.is_held != last.is_held) {
        report({now.unix_us, now.sample.is_held ? EventLevel::warning : EventLevel::info,
                now.sample.is_held ? "feed held" : "feed free"});
    }
}

void compare_conditions(const TelemetrySample& last, const Telemetry& now, const Report& report) {
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        const auto condition = static_cast<firmware::Condition>(k);
        const bool is_there = now.sample.conditions.has(condition);
        if (is_there != last.conditions.has(condition)) {
            report({now.unix_us, is_there ? EventLevel::warning : EventLevel::info,
                    fmt::format("{}{}", firmware::name(condition), is_there ? "" : " ended")});
        }
    }
}

void compare_tools(const TelemetrySample& last, const Telemetry& now, const Report& report) {
    if (now.sample.tool != last.tool) {
        report({now.unix_us, EventLevel::info,
                now.sample.tool != 0 ? fmt::format("tool {}", now.sample.tool) : "tool not known"});
    }
}

}  // namespace

void EventWatch::follow(const Telemetry& telemetry, const Report& report) {
    const bool is_first = !last_ || is_new_run(*last_, telemetry.sample);
    if (is_first) {
        report({telemetry.unix_us, EventLevel::info, "run begins"});
    }
    const TelemetrySample before = last_.value_or(TelemetrySample{});
    compare_faults(before, telemetry, report);
    compare_holds(before, telemetry, report);
    compare_conditions(before, telemetry, report);
    compare_tools(before, telemetry, report);
    last_ = telemetry.sample;
}

}  // namespace millforce::host
