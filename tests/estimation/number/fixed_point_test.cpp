// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

// The oracle is the C library in double; wide integers for the arithmetic, where the compiler has them.

using millforce::estimation::Fixed;
using millforce::estimation::saturations;
namespace detail = millforce::estimation::detail;
using Raw = std::int64_t;

namespace {

constexpr double resolution = 1.0 / 4294967296.0;
constexpr Raw highest = INT64_MAX;

double value_of(Fixed fixed) {
    return static_cast<double>(fixed.raw()) * resolution;
}

/// Raw values of every size, and those at the edges of sizes.
class RawNumbers {
  public:
    Raw next() {
        const unsigned bits = static_cast<unsigned>(engine_() % 63U);
        const Raw size = engine_() % 8U == 0U ? (Raw{1} << bits) - static_cast<Raw>(engine_() % 3U)
                                              : static_cast<Raw>((engine_() >> 1U) >> bits);
        return (engine_() & 1U) != 0U ? size : -size;
    }
    /// Of a number between the bounds.
    Fixed between(double low, double high) {
        const double share = static_cast<double>(engine_() >> 11U) / 9007199254740992.0;
        return Fixed::from_raw(static_cast<Raw>((low + (high - low) * share) / resolution));
    }

  private:
    std::mt19937_64 engine_{5};
};

std::uint32_t counted(Fixed (*operation)(Fixed, Fixed), Fixed a, Fixed b) {
    const std::uint32_t before = saturations();
    operation(a, b);
    return saturations() - before;
}

/// Of a product: the 128 bits of |a| |b|, bit by bit.
struct Product {
    std::uint64_t high = 0;
    std::uint64_t low = 0;
};
Product product_of_sizes(Raw a, Raw b) {
    const auto size_of = [](Raw raw) {
        return raw < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(raw) : static_cast<std::uint64_t>(raw);
    };
    const std::uint64_t x = size_of(a);
    const std::uint64_t y = size_of(b);
    Product product;
    for (unsigned bit = 64; bit-- > 0;) {
        product.high = product.high << 1U | product.low >> 63U;
        product.low <<= 1U;
        if ((y >> bit & 1U) != 0U) {
            product.low += x;
            product.high += product.low < x ? 1U : 0U;
        }
    }
    return product;
}

/// To nearest, halves upwards; clipped.
Raw rounded_product(Raw a, Raw b) {
    Product exact = product_of_sizes(a, b);
    const bool negative = (a < 0) != (b < 0);
    const std::uint64_t half = negative ? 0x7FFF'FFFFU : 0x8000'0000U;
    exact.low += half;
    exact.high += exact.low < half ? 1U : 0U;
    const std::uint64_t size = exact.high << 32U | exact.low >> 32U;
    const bool fits = exact.high >> 31U == 0U;
    const Raw clipped = fits ? static_cast<Raw>(size) : highest;
    return negative ? -clipped : clipped;
}

Fixed sum(Fixed a, Fixed b) {
    return a + b;
}
Fixed difference(Fixed a, Fixed b) {
    return a - b;
}
Fixed product(Fixed a, Fixed b) {
    return a * b;
}
Fixed quotient(Fixed a, Fixed b) {
    return a / b;
}

/// The largest difference between a function and its oracle over a range.
template <typename Function, typename Oracle>
double largest_error(double low, double high, Function function, Oracle oracle) {
    RawNumbers numbers;
    double largest = 0.0;
    for (int k = 0; k < 20000; ++k) {
        const Fixed x = numbers.between(low, high);
        largest = std::max(largest, std::abs(value_of(function(x)) - oracle(value_of(x))));
    }
    return largest;
}

}  // namespace

TEST_GROUP(FixedPoint){};

TEST(FixedPoint, a_product_is_the_exact_one_rounded_to_nearest) {
    RawNumbers numbers;
    for (int k = 0; k < 20000; ++k) {
        const Raw a = numbers.next();
        const Raw b = numbers.next();
        CHECK_TRUE(rounded_product(a, b) == (Fixed::from_raw(a) * Fixed::from_raw(b)).raw());
        CHECK_TRUE(rounded_product(a, b) == detail::multiply_by_words<detail::NeverSaturates>(a, b));
    }
}

TEST(FixedPoint, a_product_is_exact_on_both_sides_of_where_a_shorter_way_ends) {
    constexpr Raw limit = Raw{32768} << 32U;
    for (const Raw a : {limit, limit - 1, limit + 1, -limit, -limit - 1, -limit + 1}) {
        for (const Raw b :
             {limit, limit - 1, -limit, -limit - 1, Raw{1} << 31U, -(Raw{1} << 31U), Raw{1}, Raw{-1}, Raw{0}}) {
            CHECK_TRUE(rounded_product(a, b) == (Fixed::from_raw(a) * Fixed::from_raw(b)).raw());
            CHECK_TRUE(rounded_product(a, b) == detail::multiply_by_words<detail::NeverSaturates>(a, b));
        }
    }
}

TEST(FixedPoint, halves_of_the_resolution_are_rounded_upwards) {
    const Fixed half(0.5F);
    CHECK_TRUE((Fixed::from_raw(3) * half).raw() == 2);
    CHECK_TRUE((Fixed::from_raw(-3) * half).raw() == -1);
}

TEST(FixedPoint, the_least_sum_of_all_is_a_number_like_others) {
    const Fixed least = Fixed::from_raw(-highest) - Fixed::from_raw(1);
    CHECK_TRUE(least < Fixed::from_raw(-highest));
    CHECK_TRUE((-least).raw() == highest);
    CHECK_TRUE(abs(least).raw() == highest);
    CHECK_TRUE((least * Fixed(-1)).raw() == highest);
    CHECK_TRUE((least * Fixed(0.5F)).raw() == -(Raw{1} << 62U));
    CHECK_TRUE((least / Fixed(2)).raw() == -(Raw{1} << 62U));
    CHECK_TRUE((Fixed(1) - least).raw() == highest);
}

#ifdef __SIZEOF_INT128__
namespace {
__extension__ using Wide = __int128;

Raw rounded_and_clipped(Wide numerator, Wide denominator) {
    const bool negative = (numerator < 0) != (denominator < 0);
    const Wide n = numerator < 0 ? -numerator : numerator;
    const Wide d = denominator < 0 ? -denominator : denominator;
    const Wide size = (2 * n + d) / (2 * d);
    const Raw clipped = size > highest ? highest : static_cast<Raw>(size);
    return negative ? -clipped : clipped;
}

/// Of a product in Q64: to nearest, halves upwards.
Raw rounded_upwards_and_clipped(Wide product) {
    const Wide rounded = (product + (Wide{1} << 31U)) >> 32U;
    return static_cast<Raw>(std::clamp<Wide>(rounded, -highest, highest));
}
}  // namespace

TEST(FixedPoint, product_and_quotient_are_the_exact_ones_rounded_to_nearest) {
    RawNumbers numbers;
    for (int k = 0; k < 200000; ++k) {
        const Raw a = numbers.next();
        const Raw b = numbers.next();
        const Fixed x = Fixed::from_raw(a);
        const Fixed y = Fixed::from_raw(b);
        const Raw exact = rounded_upwards_and_clipped(Wide{a} * b);
        CHECK_TRUE(exact == (x * y).raw());
        CHECK_TRUE(exact == detail::multiply_by_words<detail::NeverSaturates>(a, b));
        if (b != 0) {
            CHECK_TRUE(rounded_and_clipped(Wide{a} * (Wide{1} << 32U), b) == (x / y).raw());
        }
    }
}
#endif

TEST(FixedPoint, what_does_not_fit_is_the_end_of_the_range_and_is_counted) {
    const Fixed big = Fixed::from_raw(highest);
    CHECK_TRUE((big + Fixed(1)).raw() == highest);
    CHECK_TRUE((-big - Fixed(1)).raw() == -highest);
    CHECK_TRUE((-big + Fixed(-1)).raw() == -highest);
    CHECK_TRUE((big - Fixed(-1)).raw() == highest);
    CHECK_TRUE((big * Fixed(-2)).raw() == -highest);
    CHECK_TRUE((big / Fixed(0.5F)).raw() == highest);
    CHECK_TRUE(Fixed(4e9F).raw() == highest);
    CHECK_TRUE(Fixed(-4000000000LL).raw() == -highest);
    UNSIGNED_LONGS_EQUAL(1, counted(sum, big, Fixed(1)));
    UNSIGNED_LONGS_EQUAL(1, counted(difference, -big, Fixed(1)));
    UNSIGNED_LONGS_EQUAL(1, counted(product, big, Fixed(2)));
    UNSIGNED_LONGS_EQUAL(1, counted(quotient, big, Fixed(0.5F)));
    UNSIGNED_LONGS_EQUAL(0, counted(product, big, Fixed(1)));
    UNSIGNED_LONGS_EQUAL(0, counted(sum, big, -big));
}

TEST(FixedPoint, a_division_by_zero_has_a_stated_result_and_is_counted) {
    CHECK_TRUE((Fixed(3) / Fixed(0)).raw() == highest);
    CHECK_TRUE((Fixed(-3) / Fixed(0)).raw() == -highest);
    CHECK_TRUE((Fixed(0) / Fixed(0)).raw() == 0);
    UNSIGNED_LONGS_EQUAL(1, counted(quotient, Fixed(3), Fixed(0)));
    UNSIGNED_LONGS_EQUAL(1, counted(quotient, Fixed(0), Fixed(0)));
}

TEST(FixedPoint, no_number_becomes_zero_and_is_counted) {
    const std::uint32_t before = saturations();
    CHECK_TRUE(Fixed(std::numeric_limits<float>::quiet_NaN()).raw() == 0);
    CHECK_TRUE(Fixed(std::numeric_limits<float>::infinity()).raw() == 0);
    UNSIGNED_LONGS_EQUAL(2, saturations() - before);
}

TEST(FixedPoint, converts_from_and_to_float_as_the_processor_does) {
    RawNumbers numbers;
    for (int k = 0; k < 100000; ++k) {
        const Fixed x = Fixed::from_raw(numbers.next());
        const auto nearest = static_cast<float>(value_of(x));
        CHECK_EQUAL(nearest, static_cast<float>(x));
        const double exact = static_cast<double>(nearest);
        if (std::abs(exact) < 2147483648.0) {
            CHECK_TRUE(std::abs(value_of(Fixed(nearest)) - exact) <= 0.5 * resolution);
        }
    }
}

TEST(FixedPoint, converts_to_integers_towards_zero) {
    LONGS_EQUAL(2, static_cast<int>(Fixed(2.75F)));
    LONGS_EQUAL(-2, static_cast<int>(Fixed(-2.75F)));
    LONGS_EQUAL(0, static_cast<int>(Fixed(-0.75F)));
}

TEST(FixedPoint, constants_are_the_nearest_raw_values) {
    CHECK_TRUE(Fixed(1e-6L).raw() == 4295);
    CHECK_TRUE(Fixed(-0.5L).raw() == -2147483648LL);
    CHECK_TRUE(static_cast<Fixed>(0.97L).raw() == 4166118277LL);
}

TEST(FixedPoint, sine_and_cosine_are_within_2e_9) {
    const auto sine = [](Fixed x) { return sin(x); };
    const auto cosine = [](Fixed x) { return cos(x); };
    for (const double range : {0.01, 4.0, 100.0, 1e5}) {
        CHECK_COMPARE(largest_error(-range, range, sine, [](double x) { return std::sin(x); }), <, 2e-9);
        CHECK_COMPARE(largest_error(-range, range, cosine, [](double x) { return std::cos(x); }), <, 2e-9);
    }
    CHECK_TRUE(sin(Fixed(0)).raw() == 0);
    CHECK_TRUE(cos(Fixed(0)) <= Fixed(1));
}

TEST(FixedPoint, tangent_is_within_2e_8_up_to_60_degrees) {
    const auto tangent = [](Fixed x) { return tan(x); };
    CHECK_COMPARE(largest_error(-1.05, 1.05, tangent, [](double x) { return std::tan(x); }), <, 2e-8);
}

TEST(FixedPoint, arc_functions_are_within_a_few_1e_9) {
    const auto arc_cosine = [](Fixed x) { return acos(x); };
    CHECK_COMPARE(largest_error(-1.0, 1.0, arc_cosine, [](double x) { return std::acos(x); }), <, 5e-9);
    CHECK_COMPARE(largest_error(0.9999, 1.0, arc_cosine, [](double x) { return std::acos(x); }), <, 1e-6);
    RawNumbers numbers;
    for (int k = 0; k < 50000; ++k) {
        const Fixed y = Fixed::from_raw(numbers.next());
        const Fixed x = Fixed::from_raw(numbers.next());
        CHECK_COMPARE(std::abs(value_of(atan2(y, x)) - std::atan2(value_of(y), value_of(x))), <, 2e-9);
    }
    CHECK_TRUE(acos(Fixed(1)).raw() == 0);
    CHECK_TRUE(acos(Fixed(1.5F)).raw() == 0);
    CHECK_TRUE(atan2(Fixed(0), Fixed(0)).raw() == 0);
}

TEST(FixedPoint, the_root_has_32_significant_bits) {
    RawNumbers numbers;
    for (int k = 0; k < 50000; ++k) {
        const Fixed x = abs(Fixed::from_raw(numbers.next()));
        const double exact = std::sqrt(value_of(x));
        CHECK_COMPARE(std::abs(value_of(sqrt(x)) - exact), <=, 1.01 * (resolution + exact * resolution));
    }
    CHECK_TRUE(sqrt(Fixed(9)) == Fixed(3));
    CHECK_TRUE(sqrt(Fixed(-4)).raw() == 0);
}

TEST(FixedPoint, exponential_logarithm_and_power_keep_a_relative_error_below_1e_8) {
    const auto exponential = [](Fixed x) { return exp(x); };
    const auto exact = [](double x) { return std::exp(x); };
    CHECK_COMPARE(largest_error(-23.0, 0.0, exponential, exact), <, 3e-9);
    CHECK_COMPARE(largest_error(0.0, 5.0, exponential, exact), <, 3e-9 * std::exp(5.0));
    CHECK_COMPARE(largest_error(20.0, 21.4, exponential, exact), <, 3e-9 * std::exp(21.4));
    const auto logarithm = [](Fixed x) { return log(x); };
    for (const double top : {1e-6, 0.01, 1.0, 1e3, 2e9}) {
        CHECK_COMPARE(largest_error(0.5 * top, top, logarithm, [](double x) { return std::log(x); }), <, 4e-9);
    }
    const auto power = [](Fixed x) { return pow(x, Fixed(-0.25F)); };
    CHECK_COMPARE(largest_error(0.001, 10.0, power, [](double x) { return std::pow(x, -0.25); }), <, 3e-8);
}

TEST(FixedPoint, exponential_and_logarithm_saturate) {
    const auto exponential = [](Fixed x, Fixed) { return exp(x); };
    const auto logarithm = [](Fixed x, Fixed) { return log(x); };
    CHECK_TRUE(exp(Fixed(22)).raw() == highest);
    CHECK_TRUE(exp(Fixed(-40)).raw() == 0);
    UNSIGNED_LONGS_EQUAL(1, counted(exponential, Fixed(40), Fixed()));
    UNSIGNED_LONGS_EQUAL(0, counted(exponential, Fixed(-40), Fixed()));
    UNSIGNED_LONGS_EQUAL(1, counted(logarithm, Fixed(0), Fixed()));
    CHECK_TRUE(log(Fixed(-1)) < Fixed(-22));
}

TEST(FixedPoint, is_a_constant_expression) {
    static_assert(Fixed(3) * Fixed(0.5F) == Fixed(1.5F));
    static_assert(sqrt(Fixed(16)) == Fixed(4));
    static_assert(exp(Fixed(0)) > Fixed(0.999F));
    static_assert(Fixed(1) / Fixed(3) < Fixed(0.3334F));
    CHECK_TRUE(Fixed(2) > Fixed(1));
}
