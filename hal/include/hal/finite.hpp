#pragma once

#include <bit>
#include <cstdint>

namespace millforce::hal {

/// Neither infinite nor NaN. By the bits: without a floating-point unit every operation on a float is a library call.
[[nodiscard]] constexpr bool is_finite(float value) {
    constexpr std::uint32_t exponent = 0x7F80'0000U;
    return (std::bit_cast<std::uint32_t>(value) & exponent) != exponent;
}

/// All of them. With a floating-point unit by their differences, two operations each.
template <typename... Floats>
[[nodiscard]] constexpr bool all_finite(Floats... values) {
#ifdef __SOFTFP__
    return (is_finite(values) && ...);
#else
    return ((values - values) + ...) == 0.0F;
#endif
}

}  // namespace millforce::hal
