// SPDX-License-Identifier: Apache-2.0
#include "program_status/position_frame.hpp"

#include "hal/finite.hpp"

namespace millforce::program_status {

namespace {

constexpr std::uint32_t largest_24_bits = 0xFFFFFF;
constexpr std::size_t distance_place = 3;
constexpr std::size_t counter_place = 6;
constexpr std::size_t position_checksum_place = frame_bytes - 1;
constexpr std::uint8_t half_of_a_byte = 0x80;

void put_24_bits(hal::CanFrame& frame, std::size_t place, std::uint32_t value) {
    for (std::size_t k = 0; k < 3; ++k) {
        frame.data[place + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

std::uint32_t get_24_bits(const hal::CanFrame& frame, std::size_t place) {
    return std::uint32_t{frame.data[place]} | (std::uint32_t{frame.data[place + 1]} << 8U) |
           (std::uint32_t{frame.data[place + 2]} << 16U);
}

std::uint32_t steps_of(float distance_mm) {
    constexpr float largest = static_cast<float>(largest_24_bits - 1);
    const float steps = distance_mm / distance_mm_per_bit + 0.5F;
    return hal::is_finite(distance_mm) && distance_mm >= 0.0F && steps <= largest ? static_cast<std::uint32_t>(steps)
                                                                                  : largest_24_bits;
}

}  // namespace

hal::CanFrame encode_position(const ProgramPosition& position, std::uint32_t id) {
    hal::CanFrame frame;
    frame.id = id & hal::largest_standard_can_id;
    frame.length = frame_bytes;
    put_24_bits(frame, 0, position.line <= largest_24_bits ? position.line : 0);
    put_24_bits(frame, distance_place, steps_of(position.distance_to_go_mm));
    frame.data[counter_place] = position.counter;
    frame.data[position_checksum_place] = checksum_of(frame);
    return frame;
}

FrameError decode_position(const hal::CanFrame& frame, std::uint32_t id, ProgramPosition& position) {
    if (frame.id != id || frame.extended || frame.remote) {
        return FrameError::not_this_frame;
    }
    if (frame.length != frame_bytes) {
        return FrameError::length;
    }
    if (frame.data[position_checksum_place] != checksum_of(frame)) {
        return FrameError::checksum;
    }
    const std::uint32_t steps = get_24_bits(frame, distance_place);
    const bool is_known = steps != largest_24_bits;
    position.line = is_known ? get_24_bits(frame, 0) : 0;
    position.distance_to_go_mm = is_known ? static_cast<float>(steps) * distance_mm_per_bit : 0.0F;
    position.counter = frame.data[counter_place];
    return FrameError::none;
}

bool PositionReceiver::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    ProgramPosition position;
    if (id_ == 0 || decode_position(frame, id_, position) != FrameError::none) {
        return false;
    }
    const auto step = static_cast<std::uint8_t>(position.counter - newest_.counter);
    if (is_fresh(time_us) && (step == 0 || step >= half_of_a_byte)) {
        return false;
    }
    newest_ = position;
    was_heard_ = true;
    fresh_us_ = time_us;
    return true;
}

ProgramPosition PositionReceiver::position(std::uint64_t now_us, float speed_mm_s) const {
    ProgramPosition position = is_fresh(now_us) ? newest_ : ProgramPosition{};
    const std::uint64_t age_us = now_us > fresh_us_ ? now_us - fresh_us_ : 0;
    const float gone_mm = speed_mm_s * 1e-6F * static_cast<float>(age_us);
    if (position.line != 0 && gone_mm > 0.0F) {
        position.distance_to_go_mm = position.distance_to_go_mm > gone_mm ? position.distance_to_go_mm - gone_mm : 0.0F;
    }
    return position;
}

}  // namespace millforce::program_status
