// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/elementary.hpp"

#include "estimation/number/circle.hpp"
#include "estimation/number/finite.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

// Coefficients of all series: interpolation at Chebyshev nodes.

namespace millforce::estimation::elementary {

namespace {

// ln 2 in two parts, the first short enough for exact products with an exponent.
constexpr float ln_2_high = 0.693359375F;
constexpr float ln_2_low = -2.12194440055e-4F;

/// x as a number of quarter turns and the angle that is left, |left| ≤ π/4.
struct QuarterTurns {
    std::int32_t count;
    float left_rad;
};

float rounded(float value) {
    constexpr float shift = 12582912.0F;  // 1.5·2²³: what is added to it is rounded to a whole number
    return (value + shift) - shift;
}

QuarterTurns quarter_turns(float x) {
    // π/2 in three parts, the first two short enough for exact products with a count of up to 2¹⁰.
    constexpr float part_1 = 1.5703125F;
    constexpr float part_2 = 4.83751296997070312e-4F;
    constexpr float part_3 = 7.54978995489188216e-8F;
    constexpr float quarter_turns_per_rad = 0.636619772F;
    constexpr float last_with_digits = 1e6F;
    if (!(x < last_with_digits && x > -last_with_digits)) {
        return {0, x - x};  // NaN for NaN and infinity; 0 where no digit of the angle is left
    }
    const float count = rounded(x * quarter_turns_per_rad);
    const float left = ((x - count * part_1) - count * part_2) - count * part_3;
    return {static_cast<std::int32_t>(count), left};
}

float sine_of_small(float x) {
    const float w = x * x;
    return x + x * w * (-0.16666664662F + w * (0.0083327482706F + w * -0.00019587890880F));
}

float cosine_of_small(float x) {
    const float w = x * x;
    return 1.0F - (0.5F * w - w * w * (0.041666664660F + w * (-0.0013888303036F + w * 0.000024547942085F)));
}

float sine_of(QuarterTurns angle) {
    const float size = (angle.count & 1) == 0 ? sine_of_small(angle.left_rad) : cosine_of_small(angle.left_rad);
    return (angle.count & 2) == 0 ? size : -size;
}

/// asin x for |x| ≤ ½.
float arc_sine_of_small(float x) {
    const float w = x * x;
    const float series =
        0.16666672415F + w * (0.074988550727F + w * (0.045001380064F + w * (0.026554542234F + w * 0.038085023517F)));
    return x + x * w * series;
}

}  // namespace

float sin(float x) {
    return sine_of(quarter_turns(x));
}

float cos(float x) {
    QuarterTurns angle = quarter_turns(x);
    ++angle.count;
    return sine_of(angle);
}

float tan(float x) {
    QuarterTurns angle = quarter_turns(x);
    const float sine = sine_of(angle);
    ++angle.count;
    return sine / sine_of(angle);
}

/// NaN outside −1…1.
float acos(float x) {
    constexpr float half_pi = 0.5F * pi<float>;
    if (x > -0.5F && x < 0.5F) {
        return half_pi - arc_sine_of_small(x);
    }
    const float half = 2.0F * arc_sine_of_small(std::sqrt(0.5F * (1.0F - (x < 0.0F ? -x : x))));
    return x < 0.0F ? pi<float> - half : half;
}

float exp(float x) {
    constexpr float highest = 88.7F;
    constexpr float lowest = -87.0F;
    constexpr float log2_e = 1.44269504089F;
    if (!(x < highest)) {
        return x > 0.0F ? HUGE_VALF : x;  // NaN stays NaN
    }
    if (x < lowest) {
        return 0.0F;
    }
    const float power = rounded(x * log2_e);
    const float r = (x - power * ln_2_high) - power * ln_2_low;
    const float series =
        0.5F + r * (0.16666666667F +
                    r * (0.041666554662F + r * (0.0083333208921F + r * (0.0013926176120F + r * 0.00019882690044F))));
    const float mantissa = 1.0F + (r + r * r * series);
    // The exponent is raised as a number of bits; 2^128 would not fit, so half of it goes by a product.
    const auto half_power = static_cast<std::int32_t>(power) / 2;
    const auto rest = static_cast<std::int32_t>(power) - half_power;
    const auto power_of_two = [](std::int32_t e) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(e + 127) << 23U);
    };
    return mantissa * power_of_two(half_power) * power_of_two(rest);
}

/// −infinity for 0, NaN below.
float log(float x) {
    if (!(x > 0.0F)) {
        return x < 0.0F || x != x ? std::numeric_limits<float>::quiet_NaN() : -HUGE_VALF;
    }
    if (!is_finite(x)) {
        return x;
    }
    constexpr float least_normal = 1.17549435e-38F;
    constexpr float up = 8388608.0F;  // 2²³
    const bool is_tiny = x < least_normal;
    const auto bits = std::bit_cast<std::uint32_t>(is_tiny ? x * up : x);
    // Exponent and mantissa so that the mantissa is √½…√2.
    const std::uint32_t shifted = bits - 0x3F35'04F3U;
    const auto exponent = static_cast<std::int32_t>(shifted) >> 23;
    const float mantissa = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(exponent) << 23U));
    const float f = mantissa - 1.0F;
    const float s = f / (2.0F + f);
    const float w = s * s;
    const float series = w * (0.33333333277F + w * (0.20000060920F + w * (0.14275410408F + w * 0.11665233610F)));
    // ln(1 + f) = 2 s + 2 s·series, with 2 s = f − s f.
    const float half_square = 0.5F * f * f;
    const float mantissa_log = f - (half_square - s * (half_square + 2.0F * series));
    const auto e = static_cast<float>(is_tiny ? exponent - 23 : exponent);
    return e * ln_2_high + (mantissa_log + e * ln_2_low);
}

}  // namespace millforce::estimation::elementary
