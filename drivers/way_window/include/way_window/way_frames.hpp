// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can_frame.hpp"

/// A part map on CAN, for a controller without files: a sender hands it a window of records, in the order of the path.
/// Two frames of 8 bytes, little endian. To the bus the controller is a CANopen node: it hears its RPDO 1 (0x200 +
/// node) and answers with its TPDO 2 (0x280 + node).
///
/// To the controller:
///
/// | bytes | what |
/// |---|---|
/// | 0 | number, low 8 bits: of the record, of the ask, or of the run |
/// | 1 | bits 0…3: kind of frame, WayFrameKind; bits 4…7: session, 1…15 |
/// | 2…6 | five bytes of the record; begin: CRC-32 of the tool's values and the layout's version; ask: 0 |
/// | 7 | CRC-8 as in the override frame, over id low, id high, bytes 0…6 |
///
/// A record is a stretch of the cut (four frames) or a block of the program (two):
///
/// | stretch, byte | what | unit and range |
/// |---|---|---|
/// | 0…3 | begin along the path, U32 | 0.001 mm |
/// | 4…6 | feed at which a tooth reaches its set point, U24 | 0.001 mm/s, from 1 on |
/// | 7…9 | mean tangential force there, U24; 0: air | 0.001 N |
/// | 10…12 | largest force of a mean tooth over it, U24 | 0.0001 |
/// | 13, 14 | force along the feed over it, S16 | 0.001 |
/// | 15, 16 | share of it that falls with the feed, U16 | 0.0001, 1…10000 |
/// | 17, 18 | how the feed falls with the hardness, U16 | 0.001, from 1 on |
/// | 19 | share of the force that is surely there, U8 | per cent, 0…100; 255: nothing is known of this stretch |
///
/// | block, byte | what | unit and range |
/// |---|---|---|
/// | 0…2 | line of the program, U24 | from 1 on |
/// | 3…6 | end along the path, U32 | 0.001 mm |
/// | 7…9 | length, U24 | 0.001 mm, at most the end |
///
/// From the controller, once for each ask:
///
/// | bytes | what |
/// |---|---|
/// | 0 | number of the ask |
/// | 1 | bits 0…3: state, WayState; bits 4…7: session; 0: none |
/// | 2, 3 | number of the record that it expects next, U16, 0 the session's first |
/// | 4 | room for so many records, 0…64 |
/// | 5, 6 | digest of all records of the session, U16 |
/// | 7 | CRC-8 as above |

namespace millforce::way_window {

inline constexpr std::uint8_t frame_bytes = 8;
inline constexpr std::uint8_t layout_version = 1;
inline constexpr std::uint8_t last_session = 15;
inline constexpr std::size_t largest_window = 64;  ///< stretches, and as many blocks

/// RPDO 1 of the controller's node.
[[nodiscard]] constexpr std::uint32_t way_frame_id(std::uint8_t node_id) {
    return 0x200U + node_id;
}
/// Its TPDO 2.
[[nodiscard]] constexpr std::uint32_t way_answer_id(std::uint8_t node_id) {
    return 0x280U + node_id;
}

enum class WayFrameKind : std::uint8_t {
    stretch = 0,  ///< the first of four
    block = 4,    ///< the first of two
    begin = 6,
    ask = 7,
};
inline constexpr std::size_t stretch_frames = 4;
inline constexpr std::size_t block_frames = 2;
inline constexpr std::size_t payload_bytes = 5;

struct StretchRecord {
    static constexpr std::uint8_t unknown_percent = 255;

    std::uint32_t begin_um = 0;
    std::uint32_t feed_um_s = 1;
    std::uint32_t tangential_mN = 0;
    std::uint32_t tooth_per_tangential_e4 = 0;
    std::int16_t feed_per_tangential_e3 = 0;
    std::uint16_t falling_share_e4 = 10'000;
    std::uint16_t feed_per_softness_e3 = 1000;
    std::uint8_t least_share_percent = 100;  ///< unknown_percent: nothing is known of this stretch

    bool operator==(const StretchRecord&) const = default;
};

struct BlockRecord {
    std::uint32_t line = 0;
    std::uint32_t end_um = 0;
    std::uint32_t length_um = 0;

    bool operator==(const BlockRecord&) const = default;
};

using StretchBytes = std::array<std::uint8_t, stretch_frames * payload_bytes>;
using BlockBytes = std::array<std::uint8_t, block_frames * payload_bytes>;

/// What does not fit its bytes is cut off: see is_sound().
[[nodiscard]] StretchBytes bytes_of(const StretchRecord& record);
[[nodiscard]] BlockBytes bytes_of(const BlockRecord& record);
[[nodiscard]] StretchRecord stretch_of(const StretchBytes& bytes);
[[nodiscard]] BlockRecord block_of(const BlockBytes& bytes);
/// All of it is within its range.
[[nodiscard]] bool is_sound(const StretchRecord& record);
[[nodiscard]] bool is_sound(const BlockRecord& record);

/// Of all records of a session, one after the other; begins with 0. CRC-16, polynomial 0x1021.
[[nodiscard]] std::uint16_t digest(std::uint16_t start, std::span<const std::uint8_t> record);

struct WayFrame {
    std::uint8_t number = 0;
    std::uint8_t kind = 0;  ///< WayFrameKind, plus the place within a record
    std::uint8_t session = 0;
    std::array<std::uint8_t, payload_bytes> payload{};
};

enum class WayState : std::uint8_t {
    waits,           ///< for a session: there was none since the start, or the program has begun again
    takes,           ///< records
    other_tool,      ///< the map is for another tool than that in the spindle
    other_layout,    ///< of these frames
    unsound_record,  ///< one out of its range, or that does not go on from the last: nothing of this session is used
    refuted,         ///< takes records, but the cut does not fit the map: it is not used until the next run
};

struct WayAnswer {
    std::uint8_t ask = 0;
    WayState state = WayState::waits;
    std::uint8_t session = 0;
    std::uint16_t expected = 0;
    std::uint8_t room = 0;
    std::uint16_t digest = 0;
};

[[nodiscard]] hal::CanFrame encode(const WayFrame& frame, std::uint32_t id);
[[nodiscard]] hal::CanFrame encode(const WayAnswer& answer, std::uint32_t id);
/// A session begins. `run`: another number for each run of a program.
[[nodiscard]] WayFrame begin_frame(std::uint8_t session, std::uint8_t run, std::uint32_t tool_checksum);

enum class FrameError : std::uint8_t {
    none,
    not_this_frame,  ///< another id, a 29-bit id or a remote frame
    length,          ///< not 8 bytes
    checksum,
    range,  ///< a kind, a session or a state that does not exist, or bytes that are not 0
};
/// Write if the frame is valid.
[[nodiscard]] FrameError decode(const hal::CanFrame& frame, std::uint32_t id, WayFrame& way_frame);
[[nodiscard]] FrameError decode(const hal::CanFrame& frame, std::uint32_t id, WayAnswer& answer);

}  // namespace millforce::way_window
