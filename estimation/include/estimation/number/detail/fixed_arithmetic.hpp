// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <type_traits>

/// Integer arithmetic behind fixed_point.hpp: 64-bit raw values in Q31.32, made of 32 × 32 → 64 bit products, which a
/// Cortex-M3 has as one instruction. Nothing here needs a 128-bit type, a floating-point unit or a library call. Where
/// the compiler takes several times what a 32-bit ARM needs, it is told the instructions: overflow by the flags, and
/// products added where their sum stands.

namespace millforce::estimation::detail {

using Raw = std::int64_t;

inline constexpr int fraction_bits = 32;
inline constexpr Raw raw_one = Raw{1} << fraction_bits;
inline constexpr Raw raw_highest = INT64_MAX;
inline constexpr Raw raw_lowest = -INT64_MAX;  // symmetric. A sum may be one less, −2³¹ itself.

// Where a product is four instructions it is worth a call: an inlined one makes the image twice as large.
#ifdef __SIZEOF_INT128__
#define MILLFORCE_CALLED inline
#else
#define MILLFORCE_CALLED [[gnu::noinline]]
#endif

constexpr std::uint64_t magnitude(Raw value) {
    return value < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}
constexpr std::uint32_t high_word(std::uint64_t value) {
    return static_cast<std::uint32_t>(value >> 32U);
}
constexpr std::uint32_t low_word(std::uint64_t value) {
    return static_cast<std::uint32_t>(value);
}
constexpr std::uint64_t product(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{a} * b;
}

constexpr std::uint64_t joined(std::uint32_t high, std::uint32_t low) {
    return std::uint64_t{high} << 32U | low;
}

constexpr Raw signed_raw(std::uint64_t magnitude_of, bool negative) {
    return negative ? -static_cast<Raw>(magnitude_of) : static_cast<Raw>(magnitude_of);
}
/// What stands in place of a result that does not fit; `Policy` hears of it.
template <typename Policy>
constexpr Raw end_of_range(bool negative) {
    Policy::saturated();
    return negative ? raw_lowest : raw_highest;
}

#if defined(__arm__) && defined(__GCC_ASM_FLAG_OUTPUTS__)
#define MILLFORCE_ARM_INSTRUCTIONS 1
#endif

/// a becomes a + b modulo 2⁶⁴. Returns whether that is not the sum.
constexpr bool add_overflows(Raw& a, Raw b) {
#ifdef MILLFORCE_ARM_INSTRUCTIONS
    if (!std::is_constant_evaluated()) {
        bool overflows = false;
        __asm__("adds %Q0, %Q0, %Q2\n\tadcs %R0, %R0, %R2" : "+&r"(a), "=@ccvs"(overflows) : "r"(b));
        return overflows;
    }
#endif
    return __builtin_add_overflow(a, b, &a);
}

/// … a − b.
constexpr bool subtract_overflows(Raw& a, Raw b) {
#ifdef MILLFORCE_ARM_INSTRUCTIONS
    if (!std::is_constant_evaluated()) {
        bool overflows = false;
        __asm__("subs %Q0, %Q0, %Q2\n\tsbcs %R0, %R0, %R2" : "+&r"(a), "=@ccvs"(overflows) : "r"(b));
        return overflows;
    }
#endif
    return __builtin_sub_overflow(a, b, &a);
}

template <typename Policy>
constexpr Raw add(Raw a, Raw b) {
    Raw sum = a;
    return add_overflows(sum, b) ? end_of_range<Policy>(b < 0) : sum;
}

template <typename Policy>
constexpr Raw subtract(Raw a, Raw b) {
    Raw difference = a;
    return subtract_overflows(difference, b) ? end_of_range<Policy>(b >= 0) : difference;
}

template <typename Policy>
constexpr Raw negate(Raw a) {
    return subtract<Policy>(0, a);
}

/// a b of two numbers below 2¹⁵, rounded to nearest, halves upwards. Worked out modulo 2⁶⁴ with the words as they are:
/// of a negative number the upper word is 2³² too large.
constexpr Raw small_product(Raw a, Raw b) {
    const std::uint32_t a_low = low_word(static_cast<std::uint64_t>(a));
    const std::uint32_t b_low = low_word(static_cast<std::uint64_t>(b));
    const std::uint32_t a_high = high_word(static_cast<std::uint64_t>(a));
    const std::uint32_t b_high = high_word(static_cast<std::uint64_t>(b));
#ifdef MILLFORCE_ARM_INSTRUCTIONS
    if (!std::is_constant_evaluated()) {
        std::uint32_t low = 0;
        std::uint32_t high = 0;
        std::uint32_t scratch = 0;
        __asm__(
            "mul %[high], %[a_high], %[b_high]\n\t"
            "and %[scratch], %[b_low], %[a_high], asr #31\n\t"
            "sub %[high], %[high], %[scratch]\n\t"
            "and %[scratch], %[a_low], %[b_high], asr #31\n\t"
            "sub %[high], %[high], %[scratch]\n\t"
            "umull %[scratch], %[low], %[a_low], %[b_low]\n\t"
            "add %[low], %[low], %[scratch], lsr #31\n\t"
            "umlal %[low], %[high], %[a_high], %[b_low]\n\t"
            "umlal %[low], %[high], %[a_low], %[b_high]"
            : [low] "=&r"(low), [high] "=&r"(high), [scratch] "=&r"(scratch)
            : [a_low] "r"(a_low), [a_high] "r"(a_high), [b_low] "r"(b_low), [b_high] "r"(b_high));
        return static_cast<Raw>(joined(high, low));
    }
#endif
    const auto if_negative = [](std::uint32_t word, Raw x) { return x < 0 ? word : 0U; };
    const std::uint64_t low = product(a_low, b_low);
    const std::uint64_t middle =
        product(a_high, b_low) + product(a_low, b_high) + high_word(low) + (low_word(low) >> 31U);
    const std::uint32_t high = high_word(middle) + a_high * b_high - if_negative(b_low, a) - if_negative(a_low, b);
    return static_cast<Raw>(joined(high, low_word(middle)));
}

/// … of any two.
template <typename Policy>
[[gnu::noinline]] constexpr Raw large_product(Raw a, Raw b) {
    const bool negative = (a ^ b) < 0;
    const std::uint64_t x = magnitude(a);
    const std::uint64_t y = magnitude(b);
    const std::uint64_t half = (1ULL << 31U) - (negative ? 1U : 0U);
    const std::uint64_t low = half + product(low_word(x), low_word(y));
    const std::uint64_t middle_a = product(high_word(x), low_word(y)) + high_word(low);
    const std::uint64_t middle_b = product(low_word(x), high_word(y)) + low_word(middle_a);
    const std::uint64_t high = product(high_word(x), high_word(y)) + high_word(middle_a) + high_word(middle_b);
    if ((high_word(high) | low_word(high) >> 31U) != 0U) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(high << 32U | low_word(middle_b), negative);
}

/// The one or the other.
template <typename Policy>
[[gnu::always_inline]] constexpr Raw product_by_words(Raw a, Raw b) {
    constexpr std::uint32_t limit = 1U << 15U;
    const std::uint32_t a_high = high_word(static_cast<std::uint64_t>(a));
    const std::uint32_t b_high = high_word(static_cast<std::uint64_t>(b));
    const bool both_are_small = ((a_high + limit) | (b_high + limit)) < 2 * limit;
    return both_are_small ? small_product(a, b) : large_product<Policy>(a, b);
}
template <typename Policy>
MILLFORCE_CALLED constexpr Raw multiply_by_words(Raw a, Raw b) {
    return product_by_words<Policy>(a, b);
}

/// The same; in one product where the processor has it.
template <typename Policy>
constexpr Raw multiply(Raw a, Raw b) {
#ifdef __SIZEOF_INT128__
    __extension__ using Wide = __int128;
    const Wide whole = (Wide{a} * b + (1LL << 31U)) >> 32U;
    if (whole > raw_highest || whole < raw_lowest) [[unlikely]] {
        return end_of_range<Policy>(whole < 0);
    }
    return static_cast<Raw>(whole);
#else
    return multiply_by_words<Policy>(a, b);
#endif
}

/// The same, never by a call.
template <typename Policy>
[[gnu::always_inline]] constexpr Raw multiply_inlined(Raw a, Raw b) {
#ifdef __SIZEOF_INT128__
    return multiply<Policy>(a, b);
#else
    return product_by_words<Policy>(a, b);
#endif
}

/// ⌊value · fraction / 2⁶⁴⌋: a product with a constant below 1 that is known to 64 bits.
constexpr std::uint64_t scaled(std::uint64_t value, std::uint64_t fraction) {
    const std::uint64_t low = product(low_word(value), low_word(fraction));
    const std::uint64_t middle_a = product(high_word(value), low_word(fraction)) + high_word(low);
    const std::uint64_t middle_b = product(low_word(value), high_word(fraction)) + low_word(middle_a);
    return product(high_word(value), high_word(fraction)) + high_word(middle_a) + high_word(middle_b);
}

/// x 2ˢ for s below 32, its upper 64 bits lost. (A shift by any number of places takes twice the instructions.)
constexpr std::uint64_t shifted_up(std::uint64_t x, unsigned s) {
    return joined(high_word(x) << s | low_word(x) >> 1U >> (31U - s), low_word(x) << s);
}

struct Digit {
    std::uint32_t quotient;
    std::uint32_t remainder;
};

/// A divisor whose highest bit is set, with ⌊(2⁶⁴ − 1)/divisor⌋ − 2³²: each digit of a quotient is then two products.
struct Divisor {
    std::uint32_t value;
    std::uint32_t reciprocal;

    constexpr explicit Divisor(std::uint32_t divisor) : value(divisor), reciprocal(0) {
        // 2⁶²/divisor to 16 bits, from the divisor's first 17; then one step of Newton's, which stays below.
        const std::uint32_t first_bits = divisor >> 15U | 1U;
        const std::uint32_t first = 0xFFFFFFFFU / first_bits;
        const std::uint32_t second = ((0xFFFFFFFFU - first * first_bits) << 15U) / first_bits;
        const std::uint32_t rough = first << 15U | second;
        const auto miss = static_cast<std::int64_t>((1ULL << 62U) - product(rough, divisor)) >> 16U;
        const std::int64_t correction =
            std::int64_t{static_cast<std::int32_t>(rough)} * static_cast<std::int32_t>(miss);
        reciprocal = (rough << 2U) + static_cast<std::uint32_t>(correction >> 44U);
        std::uint64_t rest = ~(product(reciprocal, divisor) + joined(divisor, 0));
        while (rest >= divisor) {
            rest -= divisor;
            ++reciprocal;
        }
    }
};

/// (high·2³² + low) / divisor for high < divisor (Möller & Granlund, Improved division by invariant integers, 2011).
constexpr Digit divide_normalised(std::uint32_t high, std::uint32_t low, const Divisor& divisor) {
    const std::uint64_t estimate = joined(high, low) + product(divisor.reciprocal, high);
    std::uint32_t quotient = high_word(estimate) + 1U;
    std::uint32_t remainder = low - quotient * divisor.value;
    if (remainder > low_word(estimate)) {
        --quotient;
        remainder += divisor.value;
    }
    if (remainder >= divisor.value) [[unlikely]] {
        ++quotient;
        remainder -= divisor.value;
    }
    return {quotient, remainder};
}

/// One digit of (high·2³² + next) / divisor for a divisor of two words whose highest bit is set and high < divisor;
/// `upper` is its upper word. `high` becomes the remainder.
constexpr std::uint32_t divide_step(std::uint64_t& high, std::uint32_t next, std::uint64_t divisor,
                                    const Divisor& upper) {
    std::uint32_t digit = 0xFFFFFFFFU;
    // Of the largest digit, where the upper words are equal.
    std::uint64_t rest = std::uint64_t{low_word(high)} + upper.value;
    if (high_word(high) < upper.value) {
        const Digit estimate = divide_normalised(high_word(high), low_word(high), upper);
        digit = estimate.quotient;
        rest = estimate.remainder;
    }
    while (high_word(rest) == 0 && product(digit, low_word(divisor)) > joined(low_word(rest), next)) {
        --digit;
        rest += upper.value;
    }
    high = joined(low_word(high), next) - digit * divisor;
    return digit;
}

/// 2³² x / y rounded to nearest, for y below 2³² and a quotient below 2⁶³.
constexpr std::uint64_t quotient_by_word(std::uint64_t x, std::uint32_t y) {
    const auto shift = static_cast<unsigned>(std::countl_zero(y));
    const Divisor divisor(y << shift);
    const std::uint64_t dividend = shifted_up(x, shift);
    const Digit first = divide_normalised(high_word(dividend), low_word(dividend), divisor);
    const Digit second = divide_normalised(first.remainder, 0, divisor);
    const std::uint64_t round_up = second.remainder >= divisor.value - second.remainder ? 1U : 0U;
    return joined(first.quotient, second.quotient) + round_up;
}

/// The same for y of 2³² and more.
constexpr std::uint64_t quotient_by_two_words(std::uint64_t x, std::uint64_t y) {
    const auto shift = static_cast<unsigned>(std::countl_zero(high_word(y)));
    const std::uint64_t divisor = shifted_up(y, shift);
    const Divisor upper(high_word(divisor));
    const std::uint64_t dividend = shifted_up(x, shift);
    std::uint64_t rest = dividend;
    std::uint32_t first = 0;
    if (x >= y) {
        rest = joined(high_word(x) >> 1U >> (31U - shift), high_word(dividend));
        first = divide_step(rest, low_word(dividend), divisor, upper);
    }
    const std::uint32_t second = divide_step(rest, 0, divisor, upper);
    return joined(first, second) + (rest >= divisor - rest ? 1U : 0U);
}

/// a / b, rounded to nearest, halves away from zero. By zero: the end of the range with the sign of a; 0 / 0 is 0.
template <typename Policy>
MILLFORCE_CALLED constexpr Raw divide(Raw a, Raw b) {
    const std::uint64_t x = magnitude(a);
    const std::uint64_t y = magnitude(b);
    const bool negative = (a ^ b) < 0;
    if (x >> 31U >= y) {
        const Raw end = end_of_range<Policy>(negative);
        return a == 0 ? 0 : end;
    }
    const std::uint64_t quotient = high_word(y) == 0 ? quotient_by_word(x, low_word(y)) : quotient_by_two_words(x, y);
    if (quotient > static_cast<std::uint64_t>(raw_highest)) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(quotient, negative);
}

}  // namespace millforce::estimation::detail
