#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>

/// Integer arithmetic behind fixed_point.hpp: 64-bit raw values in Q31.32, made of 32 × 32 → 64 bit products, which a
/// Cortex-M3 has as one instruction. Nothing here needs a 128-bit type, a floating-point unit or a library call.

namespace millforce::estimation::detail {

using Raw = std::int64_t;

inline constexpr int fraction_bits = 32;
inline constexpr Raw raw_one = Raw{1} << fraction_bits;
inline constexpr Raw raw_highest = INT64_MAX;
inline constexpr Raw raw_lowest = -INT64_MAX;  // symmetric: −x and |x| never overflow

// Where a product is four instructions it is worth a call: an inlined one makes the image twice as large.
#ifdef __SIZEOF_INT128__
#define MILLFORCE_CALLED inline
#else
#define MILLFORCE_CALLED [[gnu::noinline]]
#endif

constexpr std::uint64_t magnitude(Raw value) {
    return value < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}
constexpr std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32U); }
constexpr std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
constexpr std::uint64_t product(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} * b; }

constexpr Raw signed_raw(std::uint64_t magnitude_of, bool negative) {
    return negative ? -static_cast<Raw>(magnitude_of) : static_cast<Raw>(magnitude_of);
}
/// What stands in place of a result that does not fit; `Policy` hears of it.
template <typename Policy>
constexpr Raw end_of_range(bool negative) {
    Policy::saturated();
    return negative ? raw_lowest : raw_highest;
}

template <typename Policy>
constexpr Raw add(Raw a, Raw b) {
    Raw sum = 0;
    if (__builtin_add_overflow(a, b, &sum) || sum == INT64_MIN) [[unlikely]] {
        return end_of_range<Policy>(a < 0);
    }
    return sum;
}

/// a b, rounded to nearest, halves away from zero. Four products of 32 bits.
template <typename Policy>
MILLFORCE_CALLED constexpr Raw multiply_by_words(Raw a, Raw b) {
    const std::uint64_t x = magnitude(a);
    const std::uint64_t y = magnitude(b);
    constexpr std::uint64_t half = 1ULL << 31U;
    const std::uint64_t low = product(low_word(x), low_word(y)) + half;
    const std::uint64_t middle =
        product(high_word(x), low_word(y)) + product(low_word(x), high_word(y)) + high_word(low);
    const std::uint64_t high = product(high_word(x), high_word(y)) + high_word(middle);
    const bool negative = (a ^ b) < 0;
    if (high >= half) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(high << 32U | low_word(middle), negative);
}

/// The same; in one product where the processor has it.
template <typename Policy>
constexpr Raw multiply(Raw a, Raw b) {
#ifdef __SIZEOF_INT128__
    __extension__ using Wide = unsigned __int128;
    constexpr std::uint64_t half = 1ULL << 31U;
    const Wide whole = Wide{magnitude(a)} * magnitude(b) + half;
    const bool negative = (a ^ b) < 0;
    if (static_cast<std::uint64_t>(whole >> 64U) >= half) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(static_cast<std::uint64_t>(whole >> 32U), negative);
#else
    return multiply_by_words<Policy>(a, b);
#endif
}

/// ⌊value · fraction / 2⁶⁴⌋: a product with a constant below 1 that is known to 64 bits.
constexpr std::uint64_t scaled(std::uint64_t value, std::uint64_t fraction) {
    const std::uint64_t low = product(low_word(value), low_word(fraction));
    const std::uint64_t middle_a = product(high_word(value), low_word(fraction)) + high_word(low);
    const std::uint64_t middle_b = product(low_word(value), high_word(fraction)) + low_word(middle_a);
    return product(high_word(value), high_word(fraction)) + high_word(middle_a) + high_word(middle_b);
}

struct Digit {
    std::uint32_t quotient;
    std::uint32_t remainder;
};

/// (high·2³² + low) / divisor for high < divisor and a divisor whose highest bit is set: two digits of 16 bits, each
/// with one 32-bit division (Knuth, The Art of Computer Programming 2, 4.3.1, algorithm D).
constexpr Digit divide_normalised(std::uint32_t high, std::uint32_t low, std::uint32_t divisor) {
    const std::uint32_t d_high = divisor >> 16U;
    const std::uint32_t d_low = divisor & 0xFFFFU;
    std::uint32_t remainder = high;
    std::uint32_t quotient = 0;
    for (const std::uint32_t next : {low >> 16U, low & 0xFFFFU}) {
        std::uint32_t digit = remainder / d_high;
        std::uint32_t rest = remainder - digit * d_high;
        while (digit >= 0x10000U || digit * d_low > (rest << 16U | next)) {
            --digit;
            rest += d_high;
            if (rest >= 0x10000U) {
                break;
            }
        }
        remainder = (remainder << 16U) + next - digit * divisor;
        quotient = quotient << 16U | digit;
    }
    return {quotient, remainder};
}

/// One digit of (high·2³² + next) / divisor for a divisor of two words whose highest bit is set and high < divisor.
/// `high` becomes the remainder.
constexpr std::uint32_t divide_step(std::uint64_t& high, std::uint32_t next, std::uint64_t divisor) {
    const std::uint32_t d_high = high_word(divisor);
    std::uint32_t digit = 0xFFFFFFFFU;
    std::uint64_t rest = std::uint64_t{low_word(high)} + d_high;  // of the largest digit, where high_word(high) is d_high
    if (high_word(high) < d_high) {
        const Digit estimate = divide_normalised(high_word(high), low_word(high), d_high);
        digit = estimate.quotient;
        rest = estimate.remainder;
    }
    while (high_word(rest) == 0 && product(digit, low_word(divisor)) > (rest << 32U | next)) {
        --digit;
        rest += d_high;
    }
    high = (high << 32U | next) - digit * divisor;
    return digit;
}

constexpr std::uint64_t joined(std::uint32_t high, std::uint32_t low) { return std::uint64_t{high} << 32U | low; }

/// 2³² x / y rounded to nearest, for y below 2³² and a quotient below 2⁶³.
constexpr std::uint64_t quotient_by_word(std::uint64_t x, std::uint32_t y) {
    const auto shift = static_cast<unsigned>(std::countl_zero(y));
    const std::uint32_t divisor = y << shift;
    const std::uint64_t dividend = x << shift;
    const Digit first = divide_normalised(high_word(dividend), low_word(dividend), divisor);
    const Digit second = divide_normalised(first.remainder, 0, divisor);
    const std::uint64_t round_up = second.remainder >= divisor - second.remainder ? 1U : 0U;
    return joined(first.quotient, second.quotient) + round_up;
}

/// The same for y of 2³² and more.
constexpr std::uint64_t quotient_by_two_words(std::uint64_t x, std::uint64_t y) {
    const auto shift = static_cast<unsigned>(std::countl_zero(y));
    const std::uint64_t divisor = y << shift;
    const std::uint64_t dividend = x << shift;
    std::uint64_t rest = joined(shift == 0 ? 0U : static_cast<std::uint32_t>(x >> (64U - shift)), high_word(dividend));
    const std::uint32_t first = divide_step(rest, low_word(dividend), divisor);
    const std::uint32_t second = divide_step(rest, 0, divisor);
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
    const std::uint64_t quotient =
        high_word(y) == 0 ? quotient_by_word(x, low_word(y)) : quotient_by_two_words(x, y);
    if (quotient > static_cast<std::uint64_t>(raw_highest)) {
        return end_of_range<Policy>(negative);
    }
    return signed_raw(quotient, negative);
}

}  // namespace millforce::estimation::detail
