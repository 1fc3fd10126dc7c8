// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>

#include "hal/can_frame.hpp"

namespace millforce {

/// A frame of these bytes, at most 8.
inline hal::CanFrame frame_of(std::uint32_t id, std::initializer_list<unsigned> bytes) {
    hal::CanFrame frame;
    frame.id = id;
    for (const unsigned byte : bytes) {
        frame.data[frame.length++] = static_cast<std::uint8_t>(byte);
    }
    return frame;
}

/// A frame of a length, all of it 0 but the first byte.
inline hal::CanFrame frame_of_length(std::uint32_t id, std::uint8_t length, std::uint8_t first = 0) {
    hal::CanFrame frame;
    frame.id = id;
    frame.length = length;
    frame.data[0] = first;
    return frame;
}

}  // namespace millforce
