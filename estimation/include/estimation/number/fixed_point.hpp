// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/detail/fixed_functions.hpp"
#include "estimation/number/stored.hpp"

#include <Eigen/Core>

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>

/// A scalar for processors without a floating-point unit: Q31.32, 64 bits, saturating. The estimators, the controller
/// and the tick are templates over it as over float.
///
///   range ±2 147 483 647.99, resolution 2⁻³² = 2.3e-10, the same for every quantity: nothing is rescaled
///
/// One format serves because of its width: the largest number of the tick is a squared force (30 kN: 9e8 N²), the
/// smallest ones that matter are drift variances per sample (1e-8). The table of quantities is in firmware/README.md.
///
/// Every operation rounds to nearest. What does not fit becomes the nearest end of the range and is counted
/// (`saturations()`); nothing wraps, there is no infinity and no NaN. x/0 is the end of the range, 0/0 is 0, both
/// counted. From float: NaN and infinity become 0, counted; where that matters, test for it before the conversion.
///
/// Functions, found by ADL: sqrt (0 for x < 0), sin, cos, tan, atan, atan2, acos, asin (argument clipped to ±1), exp,
/// log, pow, floor, ceil, abs. Errors: sqrt 2⁻³² relative; sin, cos, atan2 2e-9; acos 3e-9, within 1e-4 of ±1 1e-6; exp
/// 3e-9 relative or half a resolution; log 2e-9.
///
/// Cost on a Cortex-M3 in instructions: + 10, × 25 (80 beyond 2¹⁵), ÷ 180, √ 500; in soft float 60, 45, 140. Not
/// thread-safe in its counter.

namespace millforce::estimation {

/// Counts what did not fit. A policy with `saw(raw)` also sees every result (tests).
struct CountSaturations {
    static inline std::uint32_t saturations = 0;
    static constexpr void saturated() {
        if (!std::is_constant_evaluated()) {
            ++saturations;
        }
    }
    static constexpr void saw(detail::Raw /*result*/) {}
};

template <typename Policy = CountSaturations>
class FixedPoint {
  public:
    using Raw = detail::Raw;

    constexpr FixedPoint() = default;
    template <std::integral Integer>
    constexpr explicit FixedPoint(Integer value) : raw_(from_integer(value)) {}
    constexpr explicit FixedPoint(float value) : raw_(from_float(value)) {}
    /// Constants of higher precision than float: at compile time only.
    template <std::floating_point Float>
    consteval explicit FixedPoint(Float value) : raw_(from_constant(value)) {}

    [[nodiscard]] static constexpr FixedPoint from_raw(Raw raw) {
        FixedPoint result;
        result.raw_ = raw;
        return result;
    }
    [[nodiscard]] constexpr Raw raw() const { return raw_; }

    constexpr explicit operator float() const { return to_float(raw_); }
    /// Towards zero, as float does. Out of the integer's range: its low bits.
    template <std::integral Integer>
    constexpr explicit operator Integer() const {
        return static_cast<Integer>(raw_ / detail::raw_one);
    }

    constexpr FixedPoint operator-() const { return from_raw(detail::subtract<Policy>(0, raw_)); }
    constexpr FixedPoint operator+() const { return *this; }
    friend constexpr FixedPoint operator+(FixedPoint a, FixedPoint b) {
        return seen(detail::add<Policy>(a.raw_, b.raw_));
    }
    friend constexpr FixedPoint operator-(FixedPoint a, FixedPoint b) {
        return seen(detail::subtract<Policy>(a.raw_, b.raw_));
    }
    friend constexpr FixedPoint operator*(FixedPoint a, FixedPoint b) {
        return seen(detail::multiply_by_words<Policy>(a.raw_, b.raw_));
    }
    friend constexpr FixedPoint operator/(FixedPoint a, FixedPoint b) {
        return seen(detail::divide<Policy>(a.raw_, b.raw_));
    }
    constexpr FixedPoint& operator+=(FixedPoint other) { return *this = *this + other; }
    constexpr FixedPoint& operator-=(FixedPoint other) { return *this = *this - other; }
    constexpr FixedPoint& operator*=(FixedPoint other) { return *this = *this * other; }
    constexpr FixedPoint& operator/=(FixedPoint other) { return *this = *this / other; }
    friend constexpr auto operator<=>(FixedPoint a, FixedPoint b) = default;

    friend constexpr FixedPoint abs(FixedPoint x) { return x.raw_ < 0 ? -x : x; }
    friend constexpr FixedPoint sqrt(FixedPoint x) { return seen(detail::raw_sqrt(x.raw_)); }
    friend constexpr FixedPoint sin(FixedPoint x) { return seen(detail::raw_sin(x.raw_)); }
    friend constexpr FixedPoint cos(FixedPoint x) { return seen(detail::raw_cos(x.raw_)); }
    friend constexpr FixedPoint tan(FixedPoint x) { return sin(x) / cos(x); }
    friend constexpr FixedPoint atan2(FixedPoint y, FixedPoint x) { return seen(detail::raw_atan2(y.raw_, x.raw_)); }
    friend constexpr FixedPoint acos(FixedPoint x) {
        const Raw inside =
            x.raw_ > detail::raw_one ? detail::raw_one : (x.raw_ < -detail::raw_one ? -detail::raw_one : x.raw_);
        return seen(detail::raw_acos(inside));
    }
    friend constexpr FixedPoint atan(FixedPoint x) { return atan2(x, FixedPoint(1)); }
    friend constexpr FixedPoint asin(FixedPoint x) { return seen(detail::raw_half_pi) - acos(x); }
    friend constexpr FixedPoint floor(FixedPoint x) { return seen(x.raw_ & ~(detail::raw_one - 1)); }
    friend constexpr FixedPoint ceil(FixedPoint x) { return -floor(-x); }
    friend constexpr bool isfinite(FixedPoint /*x*/) { return true; }
    friend constexpr FixedPoint exp(FixedPoint x) { return seen(detail::raw_exp<Policy>(x.raw_)); }
    friend constexpr FixedPoint log(FixedPoint x) { return seen(detail::raw_log<Policy>(x.raw_)); }
    friend constexpr FixedPoint pow(FixedPoint base, FixedPoint exponent) { return exp(exponent * log(base)); }

  private:
    static constexpr FixedPoint seen(Raw raw) {
        Policy::saw(raw);
        return from_raw(raw);
    }
    template <typename Integer>
    static constexpr Raw from_integer(Integer value) {
        if constexpr (std::signed_integral<Integer> && sizeof(Integer) <= sizeof(std::int32_t)) {
            return Raw{value} * detail::raw_one;
        } else {
            constexpr Integer zero{0};
            constexpr std::uint64_t most = INT32_MAX;
            const bool negative = value < zero;
            const std::uint64_t size =
                negative ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
            if (size > most) {
                return detail::end_of_range<Policy>(negative);
            }
            return detail::signed_raw(size << 32U, negative);
        }
    }

    template <typename Float>
    static consteval Raw from_constant(Float value) {
        const Float scaled =
            value * Float{4294967296} + (value < Float{0} ? static_cast<Float>(-0.5L) : static_cast<Float>(0.5L));
        constexpr auto most = static_cast<Float>(detail::raw_highest);
        return scaled >= most ? detail::raw_highest : (scaled <= -most ? detail::raw_lowest : static_cast<Raw>(scaled));
    }

    /// By the bits: without a floating-point unit every operation on a float is a library call.
    static constexpr Raw from_float(float value) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        const bool negative = (bits >> 31U) != 0U;
        const std::uint32_t exponent = bits >> 23U & 0xFFU;
        const std::uint32_t mantissa = bits << 8U | 0x8000'0000U;
        constexpr std::uint32_t of_half = 126;  // |value| is then the mantissa as raw
        if (exponent < of_half) {
            const std::uint32_t down = of_half - 1U - exponent;
            const std::uint32_t twice = down < 32U ? mantissa >> down : 0U;
            return detail::signed_raw((twice + 1U) >> 1U, negative);
        }
        const std::uint32_t up = exponent - of_half;
        // Unlikely: no parameter and no signal reaches 2³¹.
        if (up > 31U) [[unlikely]] {
            return out_of_range(exponent, negative);
        }
        return detail::signed_raw(std::uint64_t{mantissa} << up, negative);
    }
    static constexpr Raw out_of_range(std::uint32_t exponent, bool negative) {
        constexpr std::uint32_t of_no_number = 0xFF;
        const Raw end = detail::end_of_range<Policy>(negative);
        return exponent == of_no_number ? 0 : end;
    }

    /// Rounded to nearest, halves to even, as the processor's own conversion.
    static constexpr float to_float(Raw raw) {
        if (raw == 0) {
            return 0.0F;
        }
        std::uint64_t m = detail::magnitude(raw);
        const auto zeros = static_cast<unsigned>(std::countl_zero(m));
        m <<= zeros;
        const std::uint64_t lost = m & 0xFF'FFFF'FFFFULL;
        std::uint32_t mantissa = static_cast<std::uint32_t>(m >> 40U);
        constexpr std::uint64_t half = 0x80'0000'0000ULL;
        mantissa += lost > half || (lost == half && (mantissa & 1U) != 0U) ? 1U : 0U;
        // A carry out of the mantissa raises the exponent by itself.
        const std::uint32_t exponent = 127U + 63U - static_cast<std::uint32_t>(detail::fraction_bits) - zeros;
        const std::uint32_t sign = raw < 0 ? 0x8000'0000U : 0U;
        return std::bit_cast<float>(sign | (((exponent - 1U) << 23U) + mantissa));
    }

    Raw raw_ = 0;
};

/// The scalar of images for processors without a floating-point unit.
using Fixed = FixedPoint<>;

template <typename Policy>
struct StoredAs<FixedPoint<Policy>> {
    using Type = float;
};

[[nodiscard]] inline std::uint32_t saturations() {
    return CountSaturations::saturations;
}

}  // namespace millforce::estimation

template <typename Policy>
class std::numeric_limits<millforce::estimation::FixedPoint<Policy>> {
    using Fixed = millforce::estimation::FixedPoint<Policy>;

  public:
    static constexpr bool is_specialized = true;
    static constexpr bool is_signed = true;
    static constexpr bool is_integer = false;
    static constexpr bool is_exact = false;
    static constexpr bool has_infinity = false;
    static constexpr bool has_quiet_NaN = false;
    static constexpr bool is_bounded = true;
    static constexpr bool is_modulo = false;
    static constexpr int radix = 2;
    static constexpr int digits = 63;
    static constexpr int digits10 = 18;
    static constexpr Fixed min() { return Fixed::from_raw(1); }
    static constexpr Fixed max() { return Fixed::from_raw(millforce::estimation::detail::raw_highest); }
    static constexpr Fixed lowest() { return Fixed::from_raw(millforce::estimation::detail::raw_lowest); }
    static constexpr Fixed epsilon() { return Fixed::from_raw(1); }
    static constexpr Fixed infinity() { return max(); }
    static constexpr Fixed quiet_NaN() { return Fixed(); }
};

template <typename Policy>
struct Eigen::NumTraits<millforce::estimation::FixedPoint<Policy>>
    : Eigen::GenericNumTraits<millforce::estimation::FixedPoint<Policy>> {
    using Fixed = millforce::estimation::FixedPoint<Policy>;
    using Real = Fixed;
    using NonInteger = Fixed;
    using Literal = Fixed;
    using Nested = Fixed;
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 1,
        RequireInitialization = 1,
        ReadCost = 2,
        AddCost = 4,
        MulCost = 40
    };
    static constexpr Fixed dummy_precision() { return Fixed::from_raw(16); }
};
