// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/detail/fixed_arithmetic.hpp"

#include <array>
#include <concepts>
#include <cstddef>

/// Elementary functions of Q31.32 raw values. Each reduces its argument to a 32-bit fraction, evaluates a polynomial in
/// Q31 (coefficients: interpolation at Chebyshev nodes, error stated beside them) and scales back. Angles in radians.
/// Error of each: fixed_point.hpp; cost 30…150 instructions on a Cortex-M3.

namespace millforce::estimation::detail {

/// For what cannot leave the range.
struct NeverSaturates {
    static constexpr void saturated() {}
};

/// A fraction in Q31, −1…1.
using Fraction = std::int32_t;

consteval Fraction q31(std::floating_point auto value) {
    return static_cast<Fraction>(value * 2147483648.0L + (value < 0.0L ? -0.5L : 0.5L));
}

constexpr std::int64_t times(std::int64_t a, Fraction b) {
    return (a * b + (1LL << 30U)) >> 31U;
}

/// c₀ + c₁ x + c₂ x² + …, by Horner.
template <std::size_t Count>
constexpr std::int64_t polynomial(const std::array<Fraction, Count>& c, Fraction x) {
    std::int64_t sum = c[Count - 1];
    for (std::size_t k = Count - 1; k > 0; --k) {
        sum = c[k - 1] + times(sum, x);
    }
    return sum;
}

/// sin(π/4 z)/z and cos(π/4 z) over z² for |z| ≤ 1: 3.4e-12, 4.8e-11.
inline constexpr std::array<Fraction, 5> sine_over_z{q31(0.78539816339404989L), q31(-0.080745512018348509L),
                                                     q31(0.0024903932101776804L), q31(-3.6572392638620647e-05L),
                                                     q31(3.089966920500022e-07L)};
inline constexpr std::array<Fraction, 5> cosine{q31(0.99999999953L), q31(-0.30842513515829034L),
                                                q31(0.01585432522844327L), q31(-0.00032593858594099717L),
                                                q31(3.5297971346924791e-06L)};

/// An angle as a quarter of the turn and what is left of it, as a share of π/4.
struct Octant {
    unsigned quarter;
    Fraction share;
};

constexpr Octant octant_of(Raw angle_rad) {
    constexpr std::uint64_t turns_per_rad = 0x28BE'60DB'9391'054AULL;  // 2⁶⁴/2π
    const std::uint64_t x = magnitude(angle_rad);
    // Turns modulo 1 in Q64: the whole turns fall off the upper end.
    const std::uint64_t turns =
        high_word(x) * turns_per_rad + wide_product(std::uint64_t{low_word(x)} << 32U, turns_per_rad).high;
    const std::uint64_t turned = angle_rad < 0 ? std::uint64_t{0} - turns : turns;
    const auto quarter = static_cast<unsigned>((turned + (1ULL << 61U)) >> 62U);
    const auto left = static_cast<std::int64_t>(turned - (std::uint64_t{quarter} << 62U));
    return {quarter, static_cast<Fraction>(left >> 30U)};
}

/// A Q31 value, also slightly above 1, as raw.
constexpr Raw raw_of_q31(std::int64_t value) {
    return value * 2;
}

constexpr Raw sine_of(Octant angle) {
    const auto square = static_cast<Fraction>(times(angle.share, angle.share) - (angle.share == INT32_MIN ? 1 : 0));
    std::int64_t value = 0;
    if ((angle.quarter & 1U) == 0U) {
        value = times(polynomial(sine_over_z, square), angle.share);
    } else {
        value = polynomial(cosine, square);
    }
    return raw_of_q31((angle.quarter & 2U) == 0U ? value : -value);
}

constexpr Raw raw_sin(Raw angle_rad) {
    return sine_of(octant_of(angle_rad));
}
constexpr Raw raw_cos(Raw angle_rad) {
    Octant angle = octant_of(angle_rad);
    angle.quarter = (angle.quarter + 1U) & 3U;
    return sine_of(angle);
}

/// atan(r)/r over r² for r ≤ tan(π/8): 2.2e-11.
inline constexpr std::array<Fraction, 7> arc_tangent_over_r{
    q31(0.99999999953L),       q31(-0.3333333209760978L),   q31(0.19999883856576739L), q31(-0.14281588772783421L),
    q31(0.11040489220095467L), q31(-0.084561927988172317L), q31(0.047073478671634861L)};

inline constexpr Raw raw_pi = 13493037705;         // π 2³²
inline constexpr Raw raw_half_pi = 6746518852;     // ½π 2³²
inline constexpr Raw raw_quarter_pi = 3373259426;  // ¼π 2³²

/// a/b in Q31 for a ≤ b, b > 0.
constexpr Fraction share_of(std::uint32_t a, std::uint32_t b) {
    if (a >= b) {
        return INT32_MAX;
    }
    return static_cast<Fraction>((std::uint64_t{a} << 31U) / b);
}

/// atan(small/large) for 0 ≤ small ≤ large, large > 0.
constexpr Raw arc_tangent(std::uint64_t small, std::uint64_t large) {
    constexpr Fraction tan_of_eighth = q31(0.414213562373095L);
    const auto shift = static_cast<unsigned>(std::countl_zero(large));
    const std::uint32_t a = high_word(small << shift);
    const std::uint32_t b = high_word(large << shift);
    const bool beyond_eighth = a > high_word(std::uint64_t{b} * static_cast<std::uint32_t>(tan_of_eighth) << 1U);
    // atan r = π/4 − atan((1 − r)/(1 + r))
    const std::uint32_t numerator = beyond_eighth ? (b - a) >> 1U : a;
    const std::uint32_t denominator = beyond_eighth ? static_cast<std::uint32_t>((std::uint64_t{a} + b) >> 1U) : b;
    const Fraction r = share_of(numerator, denominator);
    const Raw angle = raw_of_q31(times(polynomial(arc_tangent_over_r, static_cast<Fraction>(times(r, r))), r));
    return beyond_eighth ? raw_quarter_pi - angle : angle;
}

/// −π…π; 0 for (0, 0).
constexpr Raw raw_atan2(Raw y, Raw x) {
    const std::uint64_t across = magnitude(y);
    const std::uint64_t along = magnitude(x);
    if (across == 0 && along == 0) {
        return 0;
    }
    Raw angle = across <= along ? arc_tangent(across, along) : raw_half_pi - arc_tangent(along, across);
    angle = x < 0 ? raw_pi - angle : angle;
    return y < 0 ? -angle : angle;
}

/// 0…π, for −1 ≤ x ≤ 1. By the half-angle, exact where x is next to ±1.
constexpr Raw raw_acos(Raw x) {
    const Raw sine = raw_sqrt(multiply_by_words<NeverSaturates>(raw_one - x, raw_one + x));
    return raw_atan2(sine, x);
}

/// 2^f over f for 0 ≤ f < 1, halved: 3e-11.
inline constexpr std::array<Fraction, 8> power_of_two{q31(0.49999999997246952L),    q31(0.34657359380182401L),
                                                      q31(0.12011317974044365L),    q31(0.0277526408415587L),
                                                      q31(0.00480678260424099575L), q31(0.00067146888157209495L),
                                                      q31(0.00007151277769011638L), q31(1.0821350466834672e-05L)};

/// 2^e for e in Q31.32.
template <typename Policy>
constexpr Raw power_of_two_of(Raw e) {
    const auto whole = static_cast<std::int32_t>(e >> fraction_bits);
    const auto fraction = static_cast<Fraction>(low_word(static_cast<std::uint64_t>(e)) >> 1U);
    if (whole >= 31) {
        return end_of_range<Policy>(false);
    }
    const std::int64_t half_power = polynomial(power_of_two, fraction);  // Q31: ½ … 1
    const int up = whole + 2;
    if (up >= 0) {
        return half_power << static_cast<unsigned>(up);
    }
    return up < -31 ? 0 : (half_power + (1LL << static_cast<unsigned>(-up - 1))) >> static_cast<unsigned>(-up);
}

constexpr Raw log2e_times(Raw x) {
    constexpr std::uint64_t log2e_minus_one = 0x7154'7652'B82F'E177ULL;  // (log₂ e − 1) 2⁶⁴
    const std::uint64_t m = magnitude(x);
    return signed_raw(m + wide_product(m, log2e_minus_one).high, x < 0);
}

/// eˣ; below −22.5 it is 0.
template <typename Policy>
constexpr Raw raw_exp(Raw x) {
    constexpr Raw highest = 22 * raw_one;
    constexpr Raw lowest = -23 * raw_one;
    if (x >= highest) {
        return end_of_range<Policy>(false);
    }
    return x <= lowest ? 0 : power_of_two_of<Policy>(log2e_times(x));
}

/// atanh(s)/s over s², halved, for |s| ≤ 0.1716: 2e-12.
inline constexpr std::array<Fraction, 5> arc_tanh_over_s{q31(0.50000000000208989L), q31(0.16666666311877293L),
                                                         q31(0.10000096167240845L), q31(0.07133762806561403L),
                                                         q31(0.059040889377370835L)};

/// ln x, x > 0; for x ≤ 0 the logarithm of half the resolution, saturated.
template <typename Policy>
constexpr Raw raw_log(Raw x) {
    constexpr Raw lowest = -98242467570;  // ln 2⁻³³
    if (x <= 0) {
        Policy::saturated();
        return lowest;
    }
    const auto zeros = std::countl_zero(static_cast<std::uint64_t>(x));
    const std::uint32_t m = high_word(static_cast<std::uint64_t>(x) << static_cast<unsigned>(zeros));  // Q31: 1…2
    constexpr std::uint32_t root_two = 0xB504'F334U;
    const bool upper = m > root_two;
    const std::int64_t exponent = 31 - zeros + (upper ? 1 : 0);
    // s = (m − 1)/(m + 1), with m/2 in place of m in the upper part.
    const std::int64_t one = upper ? 0x1'0000'0000LL : 0x8000'0000LL;
    const std::int64_t difference = std::int64_t{m} - one;
    const std::uint64_t sum = static_cast<std::uint64_t>(std::int64_t{m} + one);
    const auto shift = static_cast<unsigned>(std::countl_zero(sum));
    const std::uint64_t dividend = magnitude(difference) << shift;
    const auto s_magnitude = share_of(high_word(dividend), high_word(sum << shift));
    const Fraction s = difference < 0 ? -s_magnitude : s_magnitude;
    const std::int64_t half_log = times(polynomial(arc_tanh_over_s, static_cast<Fraction>(times(s, s))), s);
    constexpr Raw ln_2 = 2977044472;  // ln 2 · 2³²
    return exponent * ln_2 + 8 * half_log;
}

}  // namespace millforce::estimation::detail
