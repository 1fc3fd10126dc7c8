// SPDX-License-Identifier: Apache-2.0
#include "override_frame/override_frame.hpp"

#include <algorithm>
#include <array>

#include "hal/finite.hpp"

namespace millforce::override_frame {

namespace {

constexpr std::uint8_t hold_bit = 0x01;

std::uint8_t checksum(const hal::CanFrame& frame) {
    std::array<std::uint8_t, 2 + frame_bytes - 1> covered{static_cast<std::uint8_t>(frame.id),
                                                          static_cast<std::uint8_t>(frame.id >> 8U)};
    std::copy_n(frame.data.begin(), frame_bytes - 1, covered.begin() + 2);
    return crc8_2f(covered);
}

}  // namespace

std::uint8_t crc8_2f(std::span<const std::uint8_t> bytes) {
    constexpr unsigned polynomial = 0x2F;
    unsigned crc = 0xFF;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 0x80U) != 0 ? (crc << 1U) ^ polynomial : crc << 1U;
        }
        crc &= 0xFFU;
    }
    return static_cast<std::uint8_t>(crc ^ 0xFFU);
}

hal::CanFrame encode(const hal::FeedOverride& feed_override, std::uint32_t id) {
    const bool is_finite = hal::is_finite(feed_override.ratio);
    const float ratio = is_finite ? std::clamp(feed_override.ratio, 0.0F, largest_ratio) : 0.0F;
    const auto bits = static_cast<std::uint16_t>(std::min(ratio / ratio_per_bit + 0.5F, 65535.0F));
    hal::CanFrame frame;
    frame.id = id & hal::largest_standard_can_id;
    frame.length = frame_bytes;
    frame.data[0] = static_cast<std::uint8_t>(bits);
    frame.data[1] = static_cast<std::uint8_t>(bits >> 8U);
    frame.data[2] = feed_override.hold || !is_finite ? hold_bit : std::uint8_t{0};
    frame.data[3] = feed_override.state;
    frame.data[4] = feed_override.fault;
    frame.data[5] = static_cast<std::uint8_t>(feed_override.heartbeat);
    frame.data[6] = static_cast<std::uint8_t>(feed_override.heartbeat >> 8U);
    frame.data[7] = checksum(frame);
    return frame;
}

FrameError decode(const hal::CanFrame& frame, std::uint32_t id, hal::FeedOverride& feed_override) {
    if (frame.id != id || frame.extended || frame.remote) {
        return FrameError::not_this_frame;
    }
    if (frame.length != frame_bytes) {
        return FrameError::length;
    }
    if (frame.data[7] != checksum(frame)) {
        return FrameError::checksum;
    }
    if ((frame.data[2] & ~hold_bit) != 0) {
        return FrameError::reserved_bits;
    }
    feed_override.ratio = static_cast<float>(frame.data[0] | (frame.data[1] << 8U)) * ratio_per_bit;
    feed_override.hold = (frame.data[2] & hold_bit) != 0;
    feed_override.state = frame.data[3];
    feed_override.fault = frame.data[4];
    feed_override.heartbeat = static_cast<std::uint32_t>(frame.data[5] | (frame.data[6] << 8U));
    return FrameError::none;
}

}  // namespace millforce::override_frame
