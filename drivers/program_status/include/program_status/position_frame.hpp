// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "program_status/program_status_frame.hpp"

/// Where in its program the tool is, as the CNC reports it on CAN: TPDO 3 of the node whose TPDO 1 is the program
/// status, so its id is greater by 0x200. A frame of 8 bytes, little endian, every 10 ms and at once where the line
/// changes. Only who looks ahead in a part map needs it; a CNC that does not send it loses nothing else.
///
/// | bytes | what | unit and range |
/// |---|---|---|
/// | 0…2 | line of the program of the block in work, U24 | 0: not known |
/// | 3…5 | way to that block's end, along its path, U24 | 0.001 mm; 0xFFFFFF: not known |
/// | 6 | counter, U8, one more with each frame | |
/// | 7 | CRC-8 as in the override frame, over id low, id high, bytes 0…6 | |

namespace millforce::program_status {

inline constexpr float distance_mm_per_bit = 0.001F;

struct ProgramPosition {
    std::uint32_t line = 0;  ///< 0: not known
    float distance_to_go_mm = 0.0F;
    std::uint8_t counter = 0;
};

/// The frame's id beside that of the program status; 0: the two do not fit, or there is no program status.
[[nodiscard]] constexpr std::uint32_t position_frame_id(std::uint32_t program_status_id) {
    return id_of_pdo(3, program_status_id);
}

/// A line beyond 24 bits, and a distance that is negative, not finite or beyond the range, go out as "not known". `id`
/// has 11 bits.
[[nodiscard]] hal::CanFrame encode_position(const ProgramPosition& position, std::uint32_t id);
/// Writes `position` if the frame is valid; line 0 where line or distance is not known.
[[nodiscard]] FrameError decode_position(const hal::CanFrame& frame, std::uint32_t id, ProgramPosition& position);

/// The controller's side: the newest position. Frames that are repeated or out of order are not used. One thread.
class PositionReceiver {
  public:
    /// Without a new frame for so long the position is not known.
    static constexpr std::uint64_t timeout_us = 50'000;

    /// `id` 0: there is no such frame on the bus.
    explicit PositionReceiver(std::uint32_t id) : id_(id) {}

    /// True if the frame is valid and new.
    bool on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    /// Line 0: not known. `speed_mm_s`: of the tool along its path; it has gone on since the frame.
    [[nodiscard]] ProgramPosition position(std::uint64_t now_us, float speed_mm_s) const;

  private:
    [[nodiscard]] bool is_fresh(std::uint64_t now_us) const { return was_heard_ && now_us <= fresh_us_ + timeout_us; }

    std::uint32_t id_;
    ProgramPosition newest_{};
    bool was_heard_ = false;
    std::uint64_t fresh_us_ = 0;
};

}  // namespace millforce::program_status
