// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace millforce::hal {

/// Neither infinite nor NaN. By the bits: without a floating-point unit every operation on a float is a library call.
[[nodiscard]] constexpr bool is_finite(float value) {
    constexpr std::uint32_t exponent = 0x7F80'0000U;
    return (std::bit_cast<std::uint32_t>(value) & exponent) != exponent;
}

/// All of them, and of a size that has a sum: by that where there is a floating-point unit, one operation each.
template <typename... Floats>
[[nodiscard]] constexpr bool all_finite(Floats... values) {
#ifdef __SOFTFP__
    return (is_finite(values) && ...);
#else
    const float sum = (values + ...);
    return sum - sum == 0.0F;
#endif
}

}  // namespace millforce::hal
