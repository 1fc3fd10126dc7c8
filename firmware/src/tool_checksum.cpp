// SPDX-License-Identifier: Apache-2.0
#include "firmware/tool_checksum.hpp"

#include <array>
#include <bit>

#include "firmware/crc32.hpp"
#include "firmware/parameter_fields.hpp"

namespace millforce::firmware {

namespace {

/// One copy of it: inlined at each of some hundred fields it would take 120 KB of flash.
[[gnu::noinline]] std::uint32_t crc_with(std::uint32_t crc, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    std::array<std::uint8_t, sizeof bits> bytes{};
    for (std::size_t k = 0; k < bytes.size(); ++k) {
        bytes[k] = static_cast<std::uint8_t>(bits >> (8U * k));
    }
    return crc32(crc, bytes);
}

}  // namespace

[[gnu::cold]] std::uint32_t tool_checksum(const ToolParameters<float>& tool) {
    std::uint32_t crc = 0;
    const auto add = [&crc](const ParameterName& /*name*/, const auto& field, float /*minimum*/, float /*maximum*/) {
        crc = crc_with(crc, static_cast<float>(field));
    };
    for_each_tool_parameter(tool, add);
    return crc;
}

}  // namespace millforce::firmware
