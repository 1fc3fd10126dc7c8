// SPDX-License-Identifier: Apache-2.0
#include "firmware/tool_checksum.hpp"

#include <array>
#include <bit>

#include "firmware/crc32.hpp"
#include "firmware/parameter_fields.hpp"

namespace millforce::firmware {

std::uint32_t tool_checksum(const ToolParameters<float>& tool) {
    std::uint32_t crc = 0;
    const auto add = [&crc](const ParameterName& /*name*/, const auto& field, float /*minimum*/, float /*maximum*/) {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(field));
        std::array<std::uint8_t, sizeof bits> bytes{};
        for (std::size_t k = 0; k < bytes.size(); ++k) {
            bytes[k] = static_cast<std::uint8_t>(bits >> (8U * k));
        }
        crc = crc32(crc, bytes);
    };
    for_each_tool_parameter(tool, add);
    return crc;
}

}  // namespace millforce::firmware
