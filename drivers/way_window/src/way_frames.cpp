// SPDX-License-Identifier: Apache-2.0
#include "way_window/way_frames.hpp"

#include <algorithm>

#include "override_frame/override_frame.hpp"

namespace millforce::way_window {

namespace {

constexpr std::size_t checksum_place = frame_bytes - 1;
constexpr std::size_t payload_place = 2;
constexpr std::uint32_t largest_24_bits = 0xFF'FFFF;
constexpr std::uint16_t whole_e4 = 10'000;
constexpr std::uint8_t whole_percent = 100;

/// Little endian, one after the other.
class Writer {
  public:
    explicit Writer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}
    Writer& put(std::uint32_t value, std::size_t count) {
        for (std::size_t k = 0; k < count; ++k) {
            bytes_[place_++] = static_cast<std::uint8_t>(value >> (8U * k));
        }
        return *this;
    }

  private:
    std::span<std::uint8_t> bytes_;
    std::size_t place_ = 0;
};

class Reader {
  public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    std::uint32_t take(std::size_t count) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < count; ++k) {
            value |= std::uint32_t{bytes_[place_++]} << (8U * k);
        }
        return value;
    }
    std::uint8_t take_u8() { return static_cast<std::uint8_t>(take(1)); }
    std::uint16_t take_u16() { return static_cast<std::uint16_t>(take(2)); }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t place_ = 0;
};

std::uint8_t checksum_of(const hal::CanFrame& frame) {
    std::array<std::uint8_t, 2 + frame_bytes - 1> covered{static_cast<std::uint8_t>(frame.id),
                                                          static_cast<std::uint8_t>(frame.id >> 8U)};
    std::copy_n(frame.data.begin(), frame_bytes - 1, covered.begin() + 2);
    return override_frame::crc8_2f(covered);
}

hal::CanFrame empty_frame(std::uint32_t id) {
    hal::CanFrame frame;
    frame.id = id & hal::largest_standard_can_id;
    frame.length = frame_bytes;
    return frame;
}

std::uint8_t nibbles(unsigned low, unsigned high) {
    return static_cast<std::uint8_t>((low & 0x0FU) | ((high & 0x0FU) << 4U));
}

FrameError check(const hal::CanFrame& frame, std::uint32_t id) {
    if (frame.id != id || frame.extended || frame.remote) {
        return FrameError::not_this_frame;
    }
    if (frame.length != frame_bytes) {
        return FrameError::length;
    }
    return frame.data[checksum_place] == checksum_of(frame) ? FrameError::none : FrameError::checksum;
}

}  // namespace

StretchBytes bytes_of(const StretchRecord& record) {
    StretchBytes bytes{};
    Writer(bytes)
        .put(record.begin_um, 4)
        .put(record.feed_um_s, 3)
        .put(record.tangential_mN, 3)
        .put(record.tooth_per_tangential_e4, 3)
        .put(static_cast<std::uint16_t>(record.feed_per_tangential_e3), 2)
        .put(record.falling_share_e4, 2)
        .put(record.feed_per_softness_e3, 2)
        .put(record.least_share_percent, 1);
    return bytes;
}

BlockBytes bytes_of(const BlockRecord& record) {
    BlockBytes bytes{};
    Writer(bytes).put(record.line, 3).put(record.end_um, 4).put(record.length_um, 3);
    return bytes;
}

StretchRecord stretch_of(const StretchBytes& bytes) {
    Reader reader(bytes);
    StretchRecord record;
    record.begin_um = reader.take(4);
    record.feed_um_s = reader.take(3);
    record.tangential_mN = reader.take(3);
    record.tooth_per_tangential_e4 = reader.take(3);
    record.feed_per_tangential_e3 = static_cast<std::int16_t>(reader.take_u16());
    record.falling_share_e4 = reader.take_u16();
    record.feed_per_softness_e3 = reader.take_u16();
    record.least_share_percent = reader.take_u8();
    return record;
}

BlockRecord block_of(const BlockBytes& bytes) {
    Reader reader(bytes);
    BlockRecord record;
    record.line = reader.take(3);
    record.end_um = reader.take(4);
    record.length_um = reader.take(3);
    return record;
}

bool is_sound(const StretchRecord& record) {
    return record.feed_um_s > 0 && record.feed_um_s <= largest_24_bits && record.tangential_mN <= largest_24_bits &&
           record.tooth_per_tangential_e4 <= largest_24_bits && record.falling_share_e4 > 0 &&
           record.falling_share_e4 <= whole_e4 && record.feed_per_softness_e3 > 0 &&
           (record.least_share_percent <= whole_percent ||
            record.least_share_percent == StretchRecord::unknown_percent);
}

bool is_sound(const BlockRecord& record) {
    return record.line > 0 && record.line <= largest_24_bits && record.length_um <= largest_24_bits &&
           record.length_um <= record.end_um;
}

std::uint16_t digest(std::uint16_t start, std::span<const std::uint8_t> record) {
    constexpr unsigned polynomial = 0x1021;
    constexpr unsigned highest_bit = 0x8000;
    unsigned crc = start;
    for (const std::uint8_t byte : record) {
        crc ^= static_cast<unsigned>(byte) << 8U;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc << 1U) ^ ((crc & highest_bit) != 0 ? polynomial : 0U);
        }
    }
    return static_cast<std::uint16_t>(crc);
}

hal::CanFrame encode(const WayFrame& way_frame, std::uint32_t id) {
    hal::CanFrame frame = empty_frame(id);
    frame.data[0] = way_frame.number;
    frame.data[1] = nibbles(way_frame.kind, way_frame.session);
    std::copy(way_frame.payload.begin(), way_frame.payload.end(), frame.data.begin() + payload_place);
    frame.data[checksum_place] = checksum_of(frame);
    return frame;
}

hal::CanFrame encode(const WayAnswer& answer, std::uint32_t id) {
    hal::CanFrame frame = empty_frame(id);
    Writer(frame.data)
        .put(answer.ask, 1)
        .put(nibbles(static_cast<unsigned>(answer.state), answer.session), 1)
        .put(answer.expected, 2)
        .put(answer.room, 1)
        .put(answer.digest, 2);
    frame.data[checksum_place] = checksum_of(frame);
    return frame;
}

WayFrame begin_frame(std::uint8_t session, std::uint8_t run, std::uint32_t tool_checksum) {
    WayFrame frame;
    frame.number = run;
    frame.kind = static_cast<std::uint8_t>(WayFrameKind::begin);
    frame.session = session;
    Writer(frame.payload).put(tool_checksum, 4).put(layout_version, 1);
    return frame;
}

FrameError decode(const hal::CanFrame& frame, std::uint32_t id, WayFrame& way_frame) {
    if (const FrameError error = check(frame, id); error != FrameError::none) {
        return error;
    }
    WayFrame found;
    found.number = frame.data[0];
    found.kind = frame.data[1] & 0x0FU;
    found.session = static_cast<std::uint8_t>(frame.data[1] >> 4U);
    std::copy_n(frame.data.begin() + payload_place, payload_bytes, found.payload.begin());
    const bool is_ask = found.kind == static_cast<std::uint8_t>(WayFrameKind::ask);
    const bool is_empty = std::all_of(found.payload.begin(), found.payload.end(), [](auto byte) { return byte == 0; });
    if (found.kind > static_cast<std::uint8_t>(WayFrameKind::ask) || found.session == 0 || (is_ask && !is_empty)) {
        return FrameError::range;
    }
    way_frame = found;
    return FrameError::none;
}

FrameError decode(const hal::CanFrame& frame, std::uint32_t id, WayAnswer& answer) {
    if (const FrameError error = check(frame, id); error != FrameError::none) {
        return error;
    }
    const unsigned state = frame.data[1] & 0x0FU;
    if (state > static_cast<unsigned>(WayState::refuted) || frame.data[4] > largest_window) {
        return FrameError::range;
    }
    Reader reader(std::span(frame.data).subspan(2));
    answer.ask = frame.data[0];
    answer.state = static_cast<WayState>(state);
    answer.session = static_cast<std::uint8_t>(frame.data[1] >> 4U);
    answer.expected = reader.take_u16();
    answer.room = reader.take_u8();
    answer.digest = reader.take_u16();
    return FrameError::none;
}

}  // namespace millforce::way_window
