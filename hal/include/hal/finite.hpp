// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace millforce::hal {

/// Neither infinite nor NaN. By the bits: without a floating-point unit every operation on a float is a library call.
/// For a scalar that may be fixed point: estimation::is_finite().
[[nodiscard]] constexpr bool is_finite(float value) {
    constexpr std::uint32_t exponent = 0x7F80'0000U;
    return (std::bit_cast<std::uint32_t>(value) & exponent) != exponent;
}

/// |value| < limit, limit > 0. False for a NaN and for infinity. By the bits, as above.
[[nodiscard]] constexpr bool is_smaller(float value, float limit) {
    constexpr std::uint32_t magnitude = 0x7FFF'FFFFU;
    return (std::bit_cast<std::uint32_t>(value) & magnitude) < std::bit_cast<std::uint32_t>(limit);
}

}  // namespace millforce::hal
