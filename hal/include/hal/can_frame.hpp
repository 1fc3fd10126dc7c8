// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// A frame of classical CAN (ISO 11898-1) as it crosses the border between a bus driver and what speaks on the bus. A
/// driver hands over only data and remote frames; error frames become states of the driver.

namespace millforce::hal {

inline constexpr std::uint32_t largest_standard_can_id = 0x7FF;
inline constexpr std::uint8_t largest_can_length = 8;

struct CanFrame {
    std::uint32_t id = 0;  ///< 11 bits, or 29 where `extended`
    bool extended = false;
    bool remote = false;
    std::uint8_t length = 0;  ///< bytes of data, 0…8; the reader must check it
    std::array<std::uint8_t, largest_can_length> data{};
};

/// Passes a frame with an 11-bit id where `(frame.id & mask) == (id & mask)`.
struct CanFilter {
    std::uint32_t id = 0;
    std::uint32_t mask = largest_standard_can_id;
};

}  // namespace millforce::hal
