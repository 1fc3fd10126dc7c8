// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

/// Drive samples in and overrides out between two programs of one machine, over a Unix socket of type SOCK_SEQPACKET.
/// The controller listens (`millforce serve`); a bridge to a CNC's own memory connects and sends one sample message per
/// servo cycle. Each is answered by one override message, in order. An invalid message ends the connection: a local
/// socket loses and alters nothing, so the other side must be a different program or version.
///
/// Each connection is a separate run: the controller starts from the beginning. Only the samples' own time counts, so
/// the same samples give the same overrides whenever they arrive.
///
/// Both messages are little endian, without padding. Numbers F32 are IEEE 754; what is "no estimate" is a NaN.
///
/// | sample, bytes | what | unit and range |
/// |---|---|---|
/// | 0…3 | "MFLK" | |
/// | 4, 5 | version of the layout, U16 | 4 |
/// | 6, 7 | kind, U16 | 1 |
/// | 8…11 | sequence, U32 | is given back in the answer |
/// | 12…15 | time, U32 | µs, wraps; only differences are used |
/// | 16…19 | spindle count, U32 | wraps |
/// | 20…23 | spindle count at the last index pulse, U32 | |
/// | 24 | number of the last index pulse, U8 | wraps; constant: no index wired |
/// | 25 | what is present, hal::Present | 0…31 |
/// | 26 | bit 0 rapid, 1 feed hold, 2 fault reset | bits 3…7 are 0 |
/// | 27 | reserved | 0 |
/// | 28…31 | spindle current, F32 | A rms, positive drives in the cutting direction |
/// | 32…43 | currents of x, y, z, F32 | A rms |
/// | 44…55 | velocities of x, y, z, F32 | mm/s, of the tool relative to the workpiece |
/// | 56…59 | programmed feed of the block in work, F32 | mm/s; 0: not known |
/// | 60…63 | operator's limit, F32 | an override, 1: none |
/// | 64…67 | program line of the block in work, U32 | 1 the first; 0: not known |
/// | 68…71 | distance to go to that block's end, F32 | mm along its path |
/// | 72…75 | number of the tool in the spindle, U32 | 0: none, or not known |
/// | 76…79 | speed that the spindle's drive is told, F32 | rad/s; 0: not known |
///
/// | override, bytes | what | unit and range |
/// |---|---|---|
/// | 0…3 | "MFLK" | |
/// | 4, 5 | version, U16 | 4 |
/// | 6, 7 | kind, U16 | 2 |
/// | 8…11 | sequence of the sample that is answered, U32 | |
/// | 12…15 | heartbeat: ticks of the controller, U32 | |
/// | 16…19 | ratio, F32 | of the programmed feed |
/// | 20 | bit 0 hold: stop the feed, whatever the ratio says; bit 1: the tool is not known, and the ratio is the
/// operator's | bits 2…7 are 0 |
/// | 21, 22, 23 | state, fault, limit, U8 | control::CutState, control::Fault, control::Limit |
/// | 24…51 | tangential force, feed force, tooth force (N), immersion and its deviation (a_e/R), axial depth and its
/// deviation (mm), F32 | NaN: no estimate; of the tooth force, also where only a bound is known |
///
/// No heap, no operating system. Any thread.

namespace millforce::local_link {

inline constexpr std::uint16_t layout_version = 4;
inline constexpr std::size_t sample_bytes = 80;
inline constexpr std::size_t override_bytes = 52;
inline constexpr std::size_t link_axes = 3;

struct SampleMessage {
    std::uint32_t sequence = 0;
    std::uint32_t time_us = 0;
    std::uint32_t spindle_count = 0;
    std::uint32_t spindle_index_count = 0;
    std::uint8_t spindle_index_number = 0;
    std::uint8_t present = 0;
    bool rapid = false;
    bool feed_hold = false;
    bool reset = false;
    float spindle_current_A = 0.0F;
    std::array<float, link_axes> axis_current_A{};
    std::array<float, link_axes> axis_velocity_mm_s{};
    float programmed_feed_mm_s = 0.0F;
    float operator_limit = 1.0F;
    std::uint32_t line = 0;
    float distance_to_go_mm = 0.0F;
    std::uint32_t tool = 0;
    float commanded_speed_rad_s = 0.0F;
};

struct OverrideMessage {
    std::uint32_t sequence = 0;
    std::uint32_t heartbeat = 0;
    float ratio = 0.0F;
    bool hold = true;
    bool tool_unknown = false;
    std::uint8_t state = 0;
    std::uint8_t fault = 0;
    std::uint8_t limit = 0;
    float tangential_N = 0.0F;
    float feed_N = 0.0F;
    float tooth_force_N = 0.0F;
    float radial_immersion = 0.0F;
    float radial_immersion_sd = 0.0F;
    float axial_depth_mm = 0.0F;
    float axial_depth_sd_mm = 0.0F;
};

using SampleBytes = std::array<std::uint8_t, sample_bytes>;
using OverrideBytes = std::array<std::uint8_t, override_bytes>;

[[nodiscard]] SampleBytes encode(const SampleMessage& message);
/// A ratio that is not finite goes out as 0 with hold.
[[nodiscard]] OverrideBytes encode(const OverrideMessage& message);

enum class MessageError : std::uint8_t {
    none,
    length,
    not_this_link,  ///< does not begin with "MFLK"
    version,
    kind,
    reserved_bits,  ///< set: a later layout
    not_a_ratio,    ///< the ratio is not finite, or negative
};
/// For messages to the user, e.g. "length".
[[nodiscard]] const char* name(MessageError error);

/// Write `message` if the bytes are valid, else leave it unchanged. Quantities that are not finite pass: to the tick
/// they are "no measurement".
[[nodiscard]] MessageError decode(std::span<const std::uint8_t> bytes, SampleMessage& message);
[[nodiscard]] MessageError decode(std::span<const std::uint8_t> bytes, OverrideMessage& message);

}  // namespace millforce::local_link
