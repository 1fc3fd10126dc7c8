// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

/// Arithmetic of raw Q31.32 values: one sum, difference, product, quotient and square root. All are made of 64-bit
/// integers, without a 128-bit type or a floating-point unit, so that a host's test runs what the chip runs, to the
/// bit.

namespace millforce::estimation::detail {

using Raw = std::int64_t;

inline constexpr int fraction_bits = 32;
inline constexpr Raw raw_one = Raw{1} << fraction_bits;
inline constexpr Raw raw_highest = INT64_MAX;
inline constexpr Raw raw_lowest = -INT64_MAX;  // symmetric. A sum may be one less, −2³¹ itself.

constexpr std::uint64_t magnitude(Raw value) {
    return value < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}
constexpr Raw signed_raw(std::uint64_t magnitude_of, bool negative) {
    return negative ? -static_cast<Raw>(magnitude_of) : static_cast<Raw>(magnitude_of);
}
constexpr std::uint32_t high_word(std::uint64_t value) {
    return static_cast<std::uint32_t>(value >> 32U);
}
constexpr std::uint32_t low_word(std::uint64_t value) {
    return static_cast<std::uint32_t>(value);
}

/// Takes the place of a result that does not fit, and reports it to `Policy`.
template <typename Policy>
constexpr Raw end_of_range(bool negative) {
    Policy::saturated();
    return negative ? raw_lowest : raw_highest;
}

template <typename Policy>
constexpr Raw add(Raw a, Raw b) {
    Raw sum = 0;
    return __builtin_add_overflow(a, b, &sum) ? end_of_range<Policy>(b < 0) : sum;
}

template <typename Policy>
constexpr Raw subtract(Raw a, Raw b) {
    Raw difference = 0;
    return __builtin_sub_overflow(a, b, &difference) ? end_of_range<Policy>(b >= 0) : difference;
}

/// The 128 bits of a product.
struct WideProduct {
    std::uint64_t high;
    std::uint64_t low;
};

/// By 32-bit words: each product of two words is one instruction of a Cortex-M3.
constexpr WideProduct wide_product(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t a_high = high_word(a);
    const std::uint64_t a_low = low_word(a);
    const std::uint64_t b_high = high_word(b);
    const std::uint64_t b_low = low_word(b);
    const std::uint64_t lowest = a_low * b_low;
    const std::uint64_t middle = a_high * b_low + high_word(lowest);
    const std::uint64_t other_middle = a_low * b_high + low_word(middle);
    return {a_high * b_high + high_word(middle) + high_word(other_middle), other_middle << 32U | low_word(lowest)};
}

/// a b of two numbers below 2¹⁵, rounded to nearest, halves upwards: (a_high 2³² + a_low)(b_high 2³² + b_low)/2³².
constexpr Raw small_product(Raw a, Raw b) {
    const std::uint64_t a_low = low_word(static_cast<std::uint64_t>(a));
    const std::uint64_t b_low = low_word(static_cast<std::uint64_t>(b));
    const Raw lowest = high_word(a_low * b_low + 0x8000'0000U);
    return (a >> fraction_bits) * b + static_cast<Raw>(a_low) * (b >> fraction_bits) + lowest;
}

/// a b of any two numbers, rounded as in small_product(). Not inlined, so that the frequent small product needs no
/// stack.
template <typename Policy>
[[gnu::noinline]] constexpr Raw large_product(Raw a, Raw b) {
    const bool negative = (a ^ b) < 0;
    const WideProduct exact = wide_product(magnitude(a), magnitude(b));
    const std::uint64_t half = negative ? 0x7FFF'FFFFU : 0x8000'0000U;  // upwards is towards zero below zero
    std::uint64_t low = 0;
    const std::uint64_t carry = __builtin_add_overflow(exact.low, half, &low) ? 1U : 0U;
    const std::uint64_t high = exact.high + carry;
    if (high >> 31U != 0U) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(high << 32U | high_word(low), negative);
}

template <typename Policy>
constexpr Raw multiply_by_words(Raw a, Raw b) {
    const auto is_small = [](Raw x) {
        constexpr std::uint32_t limit = 1U << 15U;
        return high_word(static_cast<std::uint64_t>(x)) + limit < 2U * limit;
    };
    return is_small(a) && is_small(b) ? small_product(a, b) : large_product<Policy>(a, b);
}

/// a / b, rounded to nearest, halves away from zero. By zero: the end of the range with the sign of a; 0 / 0 is 0.
template <typename Policy>
constexpr Raw divide(Raw a, Raw b) {
    const bool negative = (a ^ b) < 0;
    const std::uint64_t dividend = magnitude(a);
    const std::uint64_t divisor = magnitude(b);
    if (dividend >> 31U >= divisor) {  // a quotient of 2³¹ or more, or a division by zero
        const Raw end = end_of_range<Policy>(negative);
        return a == 0 ? 0 : end;
    }
    std::uint64_t quotient = dividend / divisor;
    std::uint64_t rest = dividend % divisor;
    // The fraction, by as many bits at a time as the rest has room for: two divisions below 2¹⁶.
    const int room = std::countl_zero(divisor);
    for (int missing = fraction_bits; missing > 0; missing -= room) {
        const int bits = missing < room ? missing : room;
        rest <<= bits;
        quotient = quotient << bits | rest / divisor;
        rest %= divisor;
    }
    quotient += rest >= divisor - rest ? 1U : 0U;
    if (quotient > static_cast<std::uint64_t>(raw_highest)) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(quotient, negative);
}

/// √m rounded to nearest, for m of 2⁶² and more: bit by bit, as by hand.
constexpr std::uint64_t rounded_root(std::uint64_t m) {
    std::uint64_t rest = m;
    std::uint64_t root = 0;
    for (std::uint64_t bit = 1ULL << 62U; bit != 0U; bit >>= 2U) {
        const std::uint64_t step = root + bit;
        root >>= 1U;
        if (rest >= step) {
            rest -= step;
            root += bit;
        }
    }
    return root + (rest > root ? 1U : 0U);
}

/// √x to 32 significant bits; 0 for x < 0.
constexpr Raw raw_sqrt(Raw x) {
    if (x <= 0) {
        return 0;
    }
    // √m has 32 bits of which none is lost. √x in raw is √(x 2³²) = √m 2^(16 − shift/2).
    const auto shift = static_cast<unsigned>(std::countl_zero(static_cast<std::uint64_t>(x))) & ~1U;
    const std::uint64_t root = rounded_root(static_cast<std::uint64_t>(x) << shift);
    const unsigned half_shift = shift / 2U;
    if (half_shift <= 16U) {
        return static_cast<Raw>(root << (16U - half_shift));
    }
    const unsigned down = half_shift - 16U;
    return static_cast<Raw>((root + (1ULL << (down - 1U))) >> down);
}

}  // namespace millforce::estimation::detail
