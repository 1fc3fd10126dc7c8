// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace millforce::firmware {

/// CRC-32 of ISO 3309 (polynomial 0xEDB88320 reflected, as Ethernet and zip). Starts with 0; goes on with its result,
/// so that pieces can be joined. Eight steps a byte: for start-up, not for the tick.
constexpr std::uint32_t crc32(std::uint32_t start, std::span<const std::uint8_t> bytes) {
    constexpr std::uint32_t polynomial = 0xEDB8'8320U;
    std::uint32_t crc = ~start;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc >> 1U) ^ ((crc & 1U) != 0U ? polynomial : 0U);
        }
    }
    return ~crc;
}

}  // namespace millforce::firmware
