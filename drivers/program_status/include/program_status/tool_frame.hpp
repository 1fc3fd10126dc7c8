// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "program_status/program_status_frame.hpp"

/// Which tool is in the spindle, as the CNC reports it on CAN: TPDO 2 of the node whose TPDO 1 is the program status,
/// so its id is greater by 0x100. A frame of 8 bytes, little endian, every 100 ms and at once where the number changes.
/// A CNC that does not send it, and a controller that does not know it, lose nothing else.
///
/// | bytes | what | range |
/// |---|---|---|
/// | 0…3 | number of the tool, U32 | 0: none, or not known |
/// | 4…6 | 0 | |
/// | 7 | CRC-8 as in the override frame, over id low, id high, bytes 0…6 | |

namespace millforce::program_status {

/// The frame's id beside that of the program status; 0: the two do not fit, or there is no program status.
[[nodiscard]] constexpr std::uint32_t tool_frame_id(std::uint32_t program_status_id) {
    constexpr std::uint32_t next_pdo = 0x100;
    const std::uint32_t id = program_status_id + next_pdo;
    return program_status_id != 0 && id <= hal::largest_standard_can_id ? id : 0;
}

/// `id` has 11 bits.
[[nodiscard]] hal::CanFrame encode_tool(std::uint32_t number, std::uint32_t id);
/// Writes `number` if the frame is valid.
[[nodiscard]] FrameError decode_tool(const hal::CanFrame& frame, std::uint32_t id, std::uint32_t& number);

/// The controller's side: the number of the newest valid frame. One thread.
class ToolReceiver {
  public:
    /// Without a frame for so long the number is not known any more.
    static constexpr std::uint64_t timeout_us = 1'000'000;

    /// `id` 0: there is no such frame on the bus.
    explicit ToolReceiver(std::uint32_t id) : id_(id) {}

    /// True if the frame is valid.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    /// 0: none, or not known.
    [[nodiscard]] std::uint32_t number(std::uint64_t now_us) const {
        return now_us <= fresh_us_ + timeout_us ? number_ : 0;
    }

  private:
    std::uint32_t id_;
    std::uint32_t number_ = 0;
    std::uint64_t fresh_us_ = 0;
};

}  // namespace millforce::program_status
