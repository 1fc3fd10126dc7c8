// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "daemon/journal.hpp"

namespace millforce::host {

/// One line of the log of `millforce run`, with its end: an estimate, or a status. The total force of an estimate is
/// worked out here.
std::string json_line(const EstimateEntry& entry, const ToolForces& forces);
std::string json_line(const StatusEntry& entry);

/// The status in one line for a person.
std::string status_line(const StatusEntry& entry);

/// `drive_lost (x), sync_lost`; empty: nothing is wrong.
std::string condition_list(const StatusEntry& entry);

}  // namespace millforce::host
