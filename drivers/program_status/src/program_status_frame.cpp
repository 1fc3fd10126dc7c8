// SPDX-License-Identifier: Apache-2.0
#include "program_status/program_status_frame.hpp"

#include <algorithm>
#include <array>

#include "hal/finite.hpp"
#include "override_frame/override_frame.hpp"

namespace millforce::program_status {

namespace {

constexpr unsigned rapid_bit = 0x01;
constexpr unsigned hold_bit = 0x02;
constexpr unsigned reset_bit = 0x04;
constexpr float largest_feed_bits = 16777215.0F;

/// NaN and infinity become 0.
std::uint32_t whole_steps(float value, float step, float largest) {
    return hal::is_finite(value) ? static_cast<std::uint32_t>(std::clamp(value / step + 0.5F, 0.0F, largest)) : 0U;
}

}  // namespace

std::uint8_t checksum_of(const hal::CanFrame& frame) {
    std::array<std::uint8_t, 2 + frame_bytes - 1> covered{static_cast<std::uint8_t>(frame.id),
                                                          static_cast<std::uint8_t>(frame.id >> 8U)};
    std::copy_n(frame.data.begin(), frame_bytes - 1, covered.begin() + 2);
    return override_frame::crc8_2f(covered);
}

hal::CanFrame encode(const ProgramStatusFrame& status, std::uint32_t id) {
    const std::uint32_t feed = whole_steps(status.program.programmed_feed_mm_s, feed_mm_s_per_bit, largest_feed_bits);
    const unsigned flags = (status.program.rapid ? rapid_bit : 0U) | (status.program.feed_hold ? hold_bit : 0U) |
                           (status.reset_fault ? reset_bit : 0U);
    hal::CanFrame frame;
    frame.id = id & hal::largest_standard_can_id;
    frame.length = frame_bytes;
    frame.data[0] = static_cast<std::uint8_t>(feed);
    frame.data[1] = static_cast<std::uint8_t>(feed >> 8U);
    frame.data[2] = static_cast<std::uint8_t>(feed >> 16U);
    frame.data[3] = static_cast<std::uint8_t>(whole_steps(status.program.operator_override, 0.01F, 255.0F));
    frame.data[4] = static_cast<std::uint8_t>(flags);
    frame.data[5] = static_cast<std::uint8_t>(status.counter);
    frame.data[6] = static_cast<std::uint8_t>(status.counter >> 8U);
    frame.data[7] = checksum_of(frame);
    return frame;
}

FrameError decode(const hal::CanFrame& frame, std::uint32_t id, ProgramStatusFrame& status) {
    if (frame.id != id || frame.extended || frame.remote) {
        return FrameError::not_this_frame;
    }
    if (frame.length != frame_bytes) {
        return FrameError::length;
    }
    if (frame.data[7] != checksum_of(frame)) {
        return FrameError::checksum;
    }
    const unsigned flags = frame.data[4];
    if ((flags & ~(rapid_bit | hold_bit | reset_bit)) != 0) {
        return FrameError::reserved_bits;
    }
    const auto feed = static_cast<std::uint32_t>(frame.data[0] | (frame.data[1] << 8U) | (frame.data[2] << 16U));
    status.program.programmed_feed_mm_s = static_cast<float>(feed) * feed_mm_s_per_bit;
    status.program.operator_override = static_cast<float>(frame.data[3]) * 0.01F;
    status.program.rapid = (flags & rapid_bit) != 0;
    status.program.feed_hold = (flags & hold_bit) != 0;
    status.reset_fault = (flags & reset_bit) != 0;
    status.counter = static_cast<std::uint16_t>(frame.data[5] | (frame.data[6] << 8U));
    return FrameError::none;
}

}  // namespace millforce::program_status
