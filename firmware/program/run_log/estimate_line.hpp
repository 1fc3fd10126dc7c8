// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "run_log/estimate_entry.hpp"
#include "run_log/tool_forces.hpp"

namespace millforce::host {

/// An estimate as one line of the log of `millforce run`, with the line's end. Its total force is worked out here.
std::string json_line(const EstimateEntry& entry, const ToolForces& forces);

/// Seconds, with all six digits.
std::string json_time(std::uint64_t time_us);

}  // namespace millforce::host
