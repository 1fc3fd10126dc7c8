// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/can_frame.hpp"

/// Which objects a transmit PDO of a drive carries, in which order and width: the contents of 0x1800 + n (CAN id,
/// transmission type) and 0x1A00 + n (objects). CiA 301: the first object begins at bit 0 of byte 0, the next follows
/// without a gap, little endian; any width of 1…64 bits, 64 bits in all.

namespace millforce::cia402 {

inline constexpr std::size_t largest_pdo_objects = 8;
inline constexpr std::size_t largest_pdo_count = 4;

struct MappedObject {
    std::uint16_t index = 0;
    std::uint8_t subindex = 0;
    std::uint8_t bits = 0;

    [[nodiscard]] bool operator==(const MappedObject&) const = default;
};

struct PdoMapping {
    std::uint32_t id = 0;                ///< CAN id; 0: this PDO is not used
    std::uint8_t transmission_type = 1;  ///< 1: at every SYNC; 2…240: at every n-th; 254, 255: by event
    std::uint8_t object_count = 0;
    std::array<MappedObject, largest_pdo_objects> objects{};

    [[nodiscard]] std::span<const MappedObject> mapped() const {
        return std::span(objects).first(object_count < largest_pdo_objects ? object_count : largest_pdo_objects);
    }
    [[nodiscard]] bool is_used() const { return id != 0; }
    [[nodiscard]] bool at_every_sync() const { return transmission_type == 1; }
};

/// First thing that is wrong with a mapping.
enum class MappingError : std::uint8_t {
    none,
    id,                 ///< not 0x181…0x57F: outside what CiA 301 leaves to PDOs
    transmission_type,  ///< 0, 241…253: acyclic and remote PDOs are not supported
    object_count,       ///< none, or more than 8
    object_width,       ///< 0 or more than 64 bits, or more than 32 for an object whose value is read
    too_long,           ///< more than 64 bits
};
[[nodiscard]] MappingError check(const PdoMapping& mapping);

/// Bytes that a frame with this mapping has: exactly.
[[nodiscard]] std::uint8_t length_bytes(const PdoMapping& mapping);

/// `bits` (1…32) of the data from `first_bit` on, little endian; bits beyond the 64th read as 0.
[[nodiscard]] std::uint32_t unsigned_bits(const std::array<std::uint8_t, hal::largest_can_length>& data,
                                          std::uint32_t first_bit, std::uint32_t bits);
/// The lowest `bits` (1…32) of `value` as two's complement.
[[nodiscard]] std::int32_t sign_extended(std::uint32_t value, std::uint32_t bits);

}  // namespace millforce::cia402
