// SPDX-License-Identifier: Apache-2.0 OR GPL-2.0-or-later
#include "local_link/messages.hpp"

#include <bit>

namespace millforce::local_link {

namespace {

constexpr std::uint32_t magic = 0x4B4C464D;  // "MFLK"
constexpr std::uint16_t sample_kind = 1;
constexpr std::uint16_t override_kind = 2;
constexpr std::uint8_t rapid_bit = 1;
constexpr std::uint8_t feed_hold_bit = 2;
constexpr std::uint8_t reset_bit = 4;
constexpr std::uint8_t hold_bit = 1;
constexpr std::uint8_t tool_unknown_bit = 2;
constexpr std::size_t head_bytes = 8;
constexpr std::uint8_t all_present_bits = 0x1F;

/// Writes values in sequence; the array is as long as the layout.
class Writer {
  public:
    explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}
    void u8(std::uint8_t value) { bytes_[place_++] = value; }
    void u16(std::uint16_t value) {
        u8(static_cast<std::uint8_t>(value));
        u8(static_cast<std::uint8_t>(value >> 8U));
    }
    void u32(std::uint32_t value) {
        u16(static_cast<std::uint16_t>(value));
        u16(static_cast<std::uint16_t>(value >> 16U));
    }
    void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
    void head(std::uint16_t kind) {
        u32(magic);
        u16(layout_version);
        u16(kind);
    }

  private:
    std::span<std::uint8_t> bytes_;
    std::size_t place_ = 0;
};

/// After head() the length is that of the layout.
class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::uint8_t u8() { return bytes_[place_++]; }
    std::uint16_t u16() {
        const unsigned low = u8();
        const unsigned high = u8();
        return static_cast<std::uint16_t>(low | (high << 8U));
    }
    std::uint32_t u32() {
        const std::uint32_t low = u16();
        const std::uint32_t high = u16();
        return low | (high << 16U);
    }
    float f32() { return std::bit_cast<float>(u32()); }
    /// The version before the length: another version has another length.
    MessageError head(std::uint16_t kind, std::size_t length) {
        if (bytes_.size() < head_bytes) {
            return MessageError::length;
        }
        if (u32() != magic) {
            return MessageError::not_this_link;
        }
        if (u16() != layout_version) {
            return MessageError::version;
        }
        if (u16() != kind) {
            return MessageError::kind;
        }
        return bytes_.size() == length ? MessageError::none : MessageError::length;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t place_ = 0;
};

/// hal::is_finite() does the same; this file also stands under the GPL and needs nothing of hal.
bool is_finite(float value) {
    return value - value == 0.0F;
}

}  // namespace

SampleBytes encode(const SampleMessage& m) {
    SampleBytes bytes{};
    Writer out(bytes);
    out.head(sample_kind);
    out.u32(m.sequence);
    out.u32(m.time_us);
    out.u32(m.spindle_count);
    out.u32(m.spindle_index_count);
    out.u8(m.spindle_index_number);
    out.u8(m.present & all_present_bits);
    out.u8(static_cast<std::uint8_t>((m.rapid ? rapid_bit : 0U) | (m.feed_hold ? feed_hold_bit : 0U) |
                                     (m.reset ? reset_bit : 0U)));
    out.u8(0);
    out.f32(m.spindle_current_A);
    for (const float current_A : m.axis_current_A) {
        out.f32(current_A);
    }
    for (const float velocity_mm_s : m.axis_velocity_mm_s) {
        out.f32(velocity_mm_s);
    }
    out.f32(m.programmed_feed_mm_s);
    out.f32(m.operator_limit);
    out.u32(m.line);
    out.f32(m.distance_to_go_mm);
    out.u32(m.tool);
    out.f32(m.commanded_speed_rad_s);
    return bytes;
}

OverrideBytes encode(const OverrideMessage& m) {
    OverrideBytes bytes{};
    Writer out(bytes);
    const bool is_a_ratio = is_finite(m.ratio) && m.ratio >= 0.0F;
    out.head(override_kind);
    out.u32(m.sequence);
    out.u32(m.heartbeat);
    out.f32(is_a_ratio ? m.ratio : 0.0F);
    out.u8(
        static_cast<std::uint8_t>((m.hold || !is_a_ratio ? hold_bit : 0U) | (m.tool_unknown ? tool_unknown_bit : 0U)));
    out.u8(m.state);
    out.u8(m.fault);
    out.u8(m.limit);
    for (const float estimate : {m.tangential_N, m.feed_N, m.tooth_force_N, m.radial_immersion, m.radial_immersion_sd,
                                 m.axial_depth_mm, m.axial_depth_sd_mm}) {
        out.f32(estimate);
    }
    return bytes;
}

MessageError decode(std::span<const std::uint8_t> bytes, SampleMessage& message) {
    Reader in(bytes);
    if (const MessageError error = in.head(sample_kind, sample_bytes); error != MessageError::none) {
        return error;
    }
    SampleMessage m;
    m.sequence = in.u32();
    m.time_us = in.u32();
    m.spindle_count = in.u32();
    m.spindle_index_count = in.u32();
    m.spindle_index_number = in.u8();
    m.present = in.u8();
    const unsigned flags = in.u8();
    const unsigned reserved = in.u8();
    if ((m.present & ~all_present_bits) != 0 || (flags & ~7U) != 0 || reserved != 0) {
        return MessageError::reserved_bits;
    }
    m.rapid = (flags & rapid_bit) != 0;
    m.feed_hold = (flags & feed_hold_bit) != 0;
    m.reset = (flags & reset_bit) != 0;
    m.spindle_current_A = in.f32();
    for (float& current_A : m.axis_current_A) {
        current_A = in.f32();
    }
    for (float& velocity_mm_s : m.axis_velocity_mm_s) {
        velocity_mm_s = in.f32();
    }
    m.programmed_feed_mm_s = in.f32();
    m.operator_limit = in.f32();
    m.line = in.u32();
    m.distance_to_go_mm = in.f32();
    m.tool = in.u32();
    m.commanded_speed_rad_s = in.f32();
    message = m;
    return MessageError::none;
}

MessageError decode(std::span<const std::uint8_t> bytes, OverrideMessage& message) {
    Reader in(bytes);
    if (const MessageError error = in.head(override_kind, override_bytes); error != MessageError::none) {
        return error;
    }
    OverrideMessage m;
    m.sequence = in.u32();
    m.heartbeat = in.u32();
    m.ratio = in.f32();
    const unsigned flags = in.u8();
    m.state = in.u8();
    m.fault = in.u8();
    m.limit = in.u8();
    for (float* estimate : {&m.tangential_N, &m.feed_N, &m.tooth_force_N, &m.radial_immersion, &m.radial_immersion_sd,
                            &m.axial_depth_mm, &m.axial_depth_sd_mm}) {
        *estimate = in.f32();
    }
    if ((flags & ~3U) != 0) {
        return MessageError::reserved_bits;
    }
    if (!is_finite(m.ratio) || m.ratio < 0.0F) {
        return MessageError::not_a_ratio;
    }
    m.hold = (flags & hold_bit) != 0;
    m.tool_unknown = (flags & tool_unknown_bit) != 0;
    message = m;
    return MessageError::none;
}

const char* name(MessageError error) {
    switch (error) {
        case MessageError::none:
            return "none";
        case MessageError::length:
            return "length";
        case MessageError::not_this_link:
            return "not this link's";
        case MessageError::version:
            return "another version of the layout";
        case MessageError::kind:
            return "kind";
        case MessageError::reserved_bits:
            return "reserved bits are set";
        case MessageError::not_a_ratio:
            return "no ratio";
    }
    return "";
}

}  // namespace millforce::local_link
