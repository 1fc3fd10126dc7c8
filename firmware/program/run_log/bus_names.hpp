// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "cia402/drive_bus.hpp"
#include "parameters/drive_names.hpp"

/// Words for the states of the bus, in logs and on the status line.

namespace millforce::host {

static_assert(drive_names.size() == cia402::drive_capacity);

constexpr const char* name(cia402::NodeState state) {
    constexpr const char* names[] = {"unused", "preparing", "refused", "starting", "operational", "lost"};
    return names[static_cast<std::size_t>(state) % 6U];
}

constexpr const char* name(cia402::PowerState state) {
    constexpr const char* names[] = {
        "unknown",     "not_ready_to_switch_on", "switch_on_disabled", "ready_to_switch_on",
        "switched_on", "operation_enabled",      "quick_stop_active",  "fault_reaction_active",
        "fault"};
    return names[static_cast<std::size_t>(state) % 9U];
}

constexpr const char* name(cia402::Reject reason) {
    constexpr const char* names[] = {
        "foreign_id",     "not_standard_data", "frame_length",   "pdo_length",          "pdo_not_operational",
        "pdo_late",       "pdo_repeated",      "current_range",  "velocity_range",      "position_step",
        "units_disagree", "sync_length",       "sync_early",     "heartbeat_malformed", "emergency_malformed",
        "sdo_malformed",  "sdo_unexpected",    "sdo_value_range"};
    static_assert(sizeof names / sizeof names[0] == cia402::reject_reasons);
    return names[static_cast<std::size_t>(reason) % cia402::reject_reasons];
}

}  // namespace millforce::host
