// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/can_frame.hpp"
#include "hal/drive_sample.hpp"
#include "hal/drive_wiring.hpp"

/// What the CNC reports about its program on CAN: one frame of 8 bytes, little endian. A CNC, or a small gateway next
/// to it, sends it every 10 ms and at once where a flag changes.
///
/// | bytes | what | unit and range |
/// |---|---|---|
/// | 0…2 | F of the current block, U24 | 0.01 mm/min: 0…167 772 mm/min; 0: not known |
/// | 3 | the operator's own override, U8 | per cent |
/// | 4 | bit 0: a rapid (G0) is active; bit 1: the feed is held; bit 2: reset the controller's fault; bits 3…7 are 0 |
/// | 5, 6 | counter, U16, one more with each frame | a counter that stops means a dead CNC |
/// | 7 | CRC-8 as in the override frame, over id low, id high, bytes 0…6 | |

namespace millforce::program_status {

inline constexpr std::uint32_t default_id = hal::default_program_status_id;
inline constexpr std::uint8_t frame_bytes = 8;
inline constexpr float feed_mm_s_per_bit = 0.01F / 60.0F;

struct ProgramStatusFrame {
    hal::ProgramStatus program{};
    bool reset_fault = false;
    std::uint16_t counter = 0;
};

/// The id of TPDO `number`, 2…4, of the node whose TPDO 1 is the program status; 0: the two do not fit, or there is no
/// program status.
[[nodiscard]] constexpr std::uint32_t id_of_pdo(std::uint32_t number, std::uint32_t program_status_id) {
    constexpr std::uint32_t ids_per_pdo = 0x100;
    const std::uint32_t id = program_status_id + (number - 1) * ids_per_pdo;
    return program_status_id != 0 && id <= hal::largest_standard_can_id ? id : 0;
}

/// CRC-8 as in the override frame, over id and all bytes but the last: of every frame by which the CNC reports.
[[nodiscard]] std::uint8_t checksum_of(const hal::CanFrame& frame);

/// A feed or an override that is not finite goes out as 0; beyond the range they saturate. `id` has 11 bits.
[[nodiscard]] hal::CanFrame encode(const ProgramStatusFrame& status, std::uint32_t id);

enum class FrameError : std::uint8_t {
    none,
    not_this_frame,  ///< another id, a 29-bit id or a remote frame
    length,          ///< not 8 bytes
    checksum,
    reserved_bits,  ///< bits 3…7 of byte 4: a later layout
};
/// Writes `status` if the frame is valid.
[[nodiscard]] FrameError decode(const hal::CanFrame& frame, std::uint32_t id, ProgramStatusFrame& status);

}  // namespace millforce::program_status
