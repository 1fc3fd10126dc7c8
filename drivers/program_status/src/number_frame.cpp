// SPDX-License-Identifier: Apache-2.0
#include "program_status/number_frame.hpp"

#include <algorithm>

namespace millforce::program_status {

namespace {

constexpr std::size_t number_bytes = 4;
constexpr std::size_t checksum_place = frame_bytes - 1;

}  // namespace

hal::CanFrame encode_number(std::uint32_t number, std::uint32_t id) {
    hal::CanFrame frame;
    frame.id = id & hal::largest_standard_can_id;
    frame.length = frame_bytes;
    for (std::size_t k = 0; k < number_bytes; ++k) {
        frame.data[k] = static_cast<std::uint8_t>(number >> (8U * k));
    }
    frame.data[checksum_place] = checksum_of(frame);
    return frame;
}

FrameError decode_number(const hal::CanFrame& frame, std::uint32_t id, std::uint32_t& number) {
    if (frame.id != id || frame.extended || frame.remote) {
        return FrameError::not_this_frame;
    }
    if (frame.length != frame_bytes) {
        return FrameError::length;
    }
    if (frame.data[checksum_place] != checksum_of(frame)) {
        return FrameError::checksum;
    }
    if (std::any_of(frame.data.begin() + number_bytes, frame.data.begin() + checksum_place,
                    [](std::uint8_t byte) { return byte != 0; })) {
        return FrameError::reserved_bits;
    }
    number = 0;
    for (std::size_t k = 0; k < number_bytes; ++k) {
        number |= std::uint32_t{frame.data[k]} << (8U * k);
    }
    return FrameError::none;
}

bool NumberReceiver::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    if (id_ == 0 || decode_number(frame, id_, number_) != FrameError::none) {
        return false;
    }
    fresh_us_ = time_us;
    return true;
}

}  // namespace millforce::program_status
