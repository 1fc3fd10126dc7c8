// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "daemon/local_drives.hpp"
#include "daemon/local_outputs.hpp"
#include "firmware_can/can_controller.hpp"
#include "run_log/estimate_entry.hpp"
#include "socketcan/can_socket.hpp"

namespace millforce::host {

/// How bus and drives are.
struct StatusEntry {
    std::uint64_t unix_us = 0;
    bool is_periodic = false;  ///< once a second; else because a condition came or went
    firmware::Conditions conditions{};
    socketcan::LinkHealth link{};
    cia402::BusHealth bus{};
    cia402::RejectCounters rejects{};
    std::array<cia402::NodeHealth, cia402::drive_capacity> drives{};
    std::array<bool, cia402::drive_capacity> is_used{};
    std::uint32_t ticks = 0;
    std::uint32_t syncs_skipped = 0;
    EstimateEntry newest{};
    LocalInputHealth input{};
    LocalOutputHealth output{};
    std::uint64_t pause_us = 0;  ///< the last time that the process was stopped, how long
};

/// The status as one line of the log of `millforce run`, with the line's end.
std::string json_line(const StatusEntry& entry);

/// The status in one line for a person.
std::string status_line(const StatusEntry& entry);

/// `drive_lost (x), sync_lost`; empty: nothing is wrong.
std::string condition_list(const StatusEntry& entry);

/// `drive_lost (x): a drive does not answer any more; sync_lost: …`, for someone who does not know the names.
std::string condition_words(const StatusEntry& entry);

}  // namespace millforce::host
