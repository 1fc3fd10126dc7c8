// SPDX-License-Identifier: Apache-2.0
#include "cia402/pdo_mapping.hpp"

#include "cia402/objects.hpp"

namespace millforce::cia402 {

MappingError check(const PdoMapping& mapping) {
    if (mapping.id <= cob_id::tpdo1 || mapping.id >= cob_id::sdo_response) {
        return MappingError::id;
    }
    if (mapping.transmission_type == 0 || (mapping.transmission_type > 240 && mapping.transmission_type < 254)) {
        return MappingError::transmission_type;
    }
    if (mapping.object_count == 0 || mapping.object_count > largest_pdo_objects) {
        return MappingError::object_count;
    }
    unsigned bits = 0;
    for (const MappedObject& object : mapping.mapped()) {
        if (object.bits == 0 || object.bits > 64) {
            return MappingError::object_width;
        }
        bits += object.bits;
    }
    return bits > 64 ? MappingError::too_long : MappingError::none;
}

std::uint8_t length_bytes(const PdoMapping& mapping) {
    unsigned bits = 0;
    for (const MappedObject& object : mapping.mapped()) {
        bits += object.bits;
    }
    return static_cast<std::uint8_t>((bits + 7U) / 8U);
}

std::uint32_t unsigned_bits(const std::array<std::uint8_t, hal::largest_can_length>& data, std::uint32_t first_bit,
                            std::uint32_t bits) {
    std::uint64_t all = 0;
    for (std::size_t k = data.size(); k-- > 0;) {
        all = (all << 8U) | data[k];
    }
    if (first_bit >= 64 || bits == 0) {
        return 0;
    }
    const std::uint64_t mask = bits >= 32 ? UINT32_MAX : (std::uint64_t{1} << bits) - 1;
    return static_cast<std::uint32_t>((all >> first_bit) & mask);
}

std::int32_t sign_extended(std::uint32_t value, std::uint32_t bits) {
    if (bits == 0 || bits >= 32) {
        return static_cast<std::int32_t>(value);
    }
    const std::uint32_t sign = std::uint32_t{1} << (bits - 1U);
    const std::uint32_t low = value & ((sign << 1U) - 1U);
    return static_cast<std::int32_t>((low ^ sign) - sign);
}

}  // namespace millforce::cia402
