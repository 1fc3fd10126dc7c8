// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"

#include <libfixmath/fix16.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>

#include <CppUTest/TestHarness.h>

// Another implementation as the oracle: libfixmath, Q16.16. Every number of its is one of ours, sixteen places up.

using millforce::estimation::Fixed;
using Raw = std::int64_t;

namespace {

constexpr Raw its_resolution = Raw{1} << 16U;
constexpr Raw half_of_its_resolution = its_resolution / 2;

Fixed ours(fix16_t x) {
    return Fixed::from_raw(Raw{x} * its_resolution);
}
Raw apart(Fixed x, fix16_t its) {
    return std::abs(x.raw() - Raw{its} * its_resolution);
}
double in_units(Raw raw) {
    return static_cast<double>(raw) / 4294967296.0;
}

/// Of every size.
class Numbers {
  public:
    fix16_t next() {
        const auto bits = static_cast<unsigned>(engine_() % 24U);
        return static_cast<fix16_t>(static_cast<std::int32_t>(engine_()) >> bits);
    }
    fix16_t between(double low, double high) {
        const double share = static_cast<double>(engine_()) / 4294967296.0;
        return static_cast<fix16_t>((low + (high - low) * share) * 65536.0);
    }

  private:
    std::mt19937 engine_{7};
};

constexpr int count = 50000;

template <typename Function, typename Its>
double farthest(double low, double high, Function function, Its its) {
    Numbers numbers;
    Raw most = 0;
    for (int k = 0; k < count; ++k) {
        const fix16_t x = numbers.between(low, high);
        most = std::max(most, apart(function(ours(x)), its(x)));
    }
    return in_units(most);
}

}  // namespace

TEST_GROUP(FixedBesideLibfixmath){};

TEST(FixedBesideLibfixmath, sums_are_the_same_to_the_bit_and_go_on_where_it_ends) {
    Numbers numbers;
    int beyond = 0;
    for (int k = 0; k < count; ++k) {
        const fix16_t a = numbers.between(-32767.0, 32767.0);
        const fix16_t b = numbers.between(-32767.0, 32767.0);
        const Fixed sum = ours(a) + ours(b);
        if (fix16_add(a, b) == fix16_overflow) {
            ++beyond;
            CHECK_TRUE(sum >= Fixed(32768) || sum <= Fixed(-32768));
        } else {
            CHECK_TRUE(apart(sum, fix16_add(a, b)) == 0);
        }
        if (fix16_sub(a, b) != fix16_overflow) {
            CHECK_TRUE(apart(ours(a) - ours(b), fix16_sub(a, b)) == 0);
        }
    }
    CHECK_TRUE(beyond > 100);
}

TEST(FixedBesideLibfixmath, products_are_its_own_before_it_rounds_and_go_on_where_it_ends) {
    Numbers numbers;
    int beyond = 0;
    for (int k = 0; k < count; ++k) {
        const fix16_t a = numbers.next();
        const fix16_t b = numbers.next();
        const fix16_t its = fix16_mul(a, b);
        const Fixed product = ours(a) * ours(b);
        if (its == fix16_overflow) {
            ++beyond;
            CHECK_TRUE(product >= Fixed(32767) || product <= Fixed(-32767));
        } else {
            CHECK_COMPARE(apart(product, its), <=, half_of_its_resolution);
        }
    }
    CHECK_TRUE(beyond > 100);
}

TEST(FixedBesideLibfixmath, quotients_are_within_its_resolution) {
    Numbers numbers;
    int compared = 0;
    for (int k = 0; k < count; ++k) {
        const fix16_t a = numbers.next();
        const fix16_t b = numbers.next();
        const fix16_t its = b != 0 ? fix16_div(a, b) : fix16_overflow;
        if (its != fix16_overflow) {
            ++compared;
            CHECK_COMPARE(apart(ours(a) / ours(b), its), <=, its_resolution);
        }
    }
    CHECK_TRUE(compared > count / 2);
}

TEST(FixedBesideLibfixmath, roots_are_its_own_before_it_rounds) {
    const auto root = [](Fixed x) { return sqrt(x); };
    CHECK_COMPARE(farthest(0.0, 4.0, root, fix16_sqrt), <=, in_units(half_of_its_resolution + 1));
    CHECK_COMPARE(farthest(0.0, 32767.0, root, fix16_sqrt), <=, in_units(half_of_its_resolution + 1));
}

TEST(FixedBesideLibfixmath, exponential_and_logarithm_agree_within_a_few_of_its_resolutions) {
    const auto exponential = [](Fixed x) { return exp(x); };
    const auto logarithm = [](Fixed x) { return log(x); };
    CHECK_COMPARE(farthest(-8.0, 0.0, exponential, fix16_exp), <, 3e-5);
    CHECK_COMPARE(farthest(0.0, 3.0, exponential, fix16_exp), <, 3e-4);
    CHECK_COMPARE(farthest(0.01, 1.0, logarithm, fix16_log), <, 4e-5);
    CHECK_COMPARE(farthest(1.0, 30000.0, logarithm, fix16_log), <, 4e-5);
}

// Its circular functions are short polynomials, 0.01 off at worst: enough to tell a wrong sign, quadrant or scale.
TEST(FixedBesideLibfixmath, circular_functions_agree_within_the_errors_of_its_own) {
    CHECK_COMPARE(farthest(
                      -3.1, 3.1, [](Fixed x) { return sin(x); }, fix16_sin),
                  <, 0.012);
    CHECK_COMPARE(farthest(
                      -3.1, 3.1, [](Fixed x) { return cos(x); }, fix16_cos),
                  <, 0.012);
    CHECK_COMPARE(farthest(
                      -0.99, 0.99, [](Fixed x) { return acos(x); }, fix16_acos),
                  <, 0.012);
    Numbers numbers;
    Raw most = 0;
    for (int k = 0; k < count; ++k) {
        const fix16_t y = numbers.between(-10.0, 10.0);
        const fix16_t x = numbers.between(-10.0, 10.0);
        most = std::max(most, apart(atan2(ours(y), ours(x)), fix16_atan2(y, x)));
    }
    CHECK_COMPARE(in_units(most), <, 0.012);
}
