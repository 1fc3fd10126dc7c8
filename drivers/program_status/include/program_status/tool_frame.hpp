// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "program_status/number_frame.hpp"

/// Which tool is in the spindle, as the CNC reports it on CAN: the number of number_frame.hpp, 0: none, or not known.
/// TPDO 2 of the node whose TPDO 1 is the program status, so its id is greater by 0x100. Every 100 ms and at once where
/// the number changes. A CNC that does not send it, and a controller that does not know it, lose nothing else.

namespace millforce::program_status {

/// The frame's id beside that of the program status; 0: the two do not fit, or there is no program status.
[[nodiscard]] constexpr std::uint32_t tool_frame_id(std::uint32_t program_status_id) {
    return id_of_pdo(2, program_status_id);
}

[[nodiscard]] inline hal::CanFrame encode_tool(std::uint32_t number, std::uint32_t id) {
    return encode_number(number, id);
}
[[nodiscard]] inline FrameError decode_tool(const hal::CanFrame& frame, std::uint32_t id, std::uint32_t& number) {
    return decode_number(frame, id, number);
}

using ToolReceiver = NumberReceiver;

}  // namespace millforce::program_status
