// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/parameters.hpp"

namespace millforce::firmware {

/// CRC-32 of all values of a tool, in the order of for_each_tool_parameter: the same on a host and on a chip that has
/// the tool from a block. For start-up and a change of the tool, not for the tick.
[[nodiscard]] std::uint32_t tool_checksum(const ToolParameters<float>& tool);

}  // namespace millforce::firmware
