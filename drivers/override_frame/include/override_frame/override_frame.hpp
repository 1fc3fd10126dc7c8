// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "hal/can_frame.hpp"
#include "hal/drive_wiring.hpp"
#include "hal/feed_override.hpp"

/// The feed override on CAN: one frame of 8 bytes, little endian, with the controller's proof that it lives.
///
/// | bytes | what | unit and range |
/// |---|---|---|
/// | 0, 1 | ratio, U16 | 0.0001 of the programmed feed: 0…65535 is 0…6.5535 |
/// | 2 | bit 0: hold, stop the feed whatever the ratio says; bits 1…7 are 0 | |
/// | 3 | state of the controller, control::CutState | |
/// | 4 | fault, control::Fault; 0: none | |
/// | 5, 6 | counter, U16: the tick's heartbeat, low 16 bits | a counter that stops means a dead tick |
/// | 7 | CRC-8 with polynomial 0x2F (AUTOSAR E2E), initial and final XOR 0xFF, over id low, id high, bytes 0…6 | |
///
/// The checksum covers the id, so that a frame of another sender is not taken for this one. To the bus the controller
/// is a CANopen node: the frame is its TPDO 1, and its heartbeat (0x700 + node, one byte, CiA 301) says `operational`
/// while ticks come, `stopped` when they stop, `pre-operational` before the first.

namespace millforce::override_frame {

inline constexpr std::uint8_t default_node_id = hal::default_override_node_id;
inline constexpr std::uint32_t default_id = hal::default_override_id;
inline constexpr std::uint8_t frame_bytes = 8;
inline constexpr float ratio_per_bit = 0.0001F;
inline constexpr float largest_ratio = 6.5535F;

/// CRC-8, polynomial 0x2F, initial and final XOR 0xFF: any three wrong bits in a frame show. Of the ASCII digits 1…9 it
/// is 0xDF.
[[nodiscard]] std::uint8_t crc8_2f(std::span<const std::uint8_t> bytes);

/// A ratio that is not finite goes out as 0 with hold; beyond the range it saturates. `id` has 11 bits.
[[nodiscard]] hal::CanFrame encode(const hal::FeedOverride& feed_override, std::uint32_t id);

enum class FrameError : std::uint8_t {
    none,
    not_this_frame,  ///< another id, a 29-bit id or a remote frame
    length,          ///< not 8 bytes
    checksum,
    reserved_bits,  ///< bits 1…7 of byte 2: a later layout
};
/// Writes `feed_override` if the frame is valid. Its heartbeat is the counter: 16 bits.
[[nodiscard]] FrameError decode(const hal::CanFrame& frame, std::uint32_t id, hal::FeedOverride& feed_override);

}  // namespace millforce::override_frame
