// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/elementary.hpp"

#include <cmath>
#include <limits>

#include <CppUTest/TestHarness.h>

namespace elementary = millforce::estimation::elementary;

namespace {

/// The largest error over a range, in units in the last place of the exact result.
template <typename Function, typename Oracle>
double largest_error(float low, float high, Function function, Oracle oracle) {
    constexpr int steps = 20000;
    double largest = 0.0;
    for (int k = 0; k <= steps; ++k) {
        const float x = low + (high - low) * static_cast<float>(k) / static_cast<float>(steps);
        const double exact = oracle(static_cast<double>(x));
        const auto size = static_cast<float>(std::abs(exact));
        const double unit = static_cast<double>(std::nextafterf(size, HUGE_VALF)) - static_cast<double>(size);
        largest = std::max(largest, std::abs(static_cast<double>(function(x)) - exact) / unit);
    }
    return largest;
}

}  // namespace

TEST_GROUP(Elementary){};

TEST(Elementary, sine_and_cosine_err_by_less_than_2_units_in_the_last_place) {
    const auto sine = [](float x) { return elementary::sin(x); };
    const auto cosine = [](float x) { return elementary::cos(x); };
    CHECK_COMPARE(largest_error(-3.1F, 3.1F, sine, [](double x) { return std::sin(x); }), <, 1.5);
    CHECK_COMPARE(largest_error(3.2F, 6.2F, sine, [](double x) { return std::sin(x); }), <, 1.5);
    CHECK_COMPARE(largest_error(-1.5F, 1.5F, cosine, [](double x) { return std::cos(x); }), <, 1.5);
    CHECK_COMPARE(largest_error(95.0F, 100.0F, sine, [](double x) { return std::sin(x); }), <, 2.2);
}

TEST(Elementary, tangent_and_arc_cosine_err_by_less_than_4_and_2_units) {
    const auto tangent = [](float x) { return elementary::tan(x); };
    const auto arc_cosine = [](float x) { return elementary::acos(x); };
    CHECK_COMPARE(largest_error(-1.5F, 1.5F, tangent, [](double x) { return std::tan(x); }), <, 4.0);
    CHECK_COMPARE(largest_error(-1.0F, 0.999F, arc_cosine, [](double x) { return std::acos(x); }), <, 2.0);
    CHECK_EQUAL(0.0F, elementary::acos(1.0F));
}

TEST(Elementary, exponential_and_logarithm_err_by_less_than_1_5_units) {
    const auto exponential = [](float x) { return elementary::exp(x); };
    const auto logarithm = [](float x) { return elementary::log(x); };
    CHECK_COMPARE(largest_error(-86.0F, 88.0F, exponential, [](double x) { return std::exp(x); }), <, 1.5);
    CHECK_COMPARE(largest_error(0.5F, 2.0F, logarithm, [](double x) { return std::log(x); }), <, 1.5);
    CHECK_COMPARE(largest_error(1e-6F, 1e6F, logarithm, [](double x) { return std::log(x); }), <, 1.5);
    CHECK_EQUAL(1.0F, elementary::exp(0.0F));
    CHECK_EQUAL(0.0F, elementary::log(1.0F));
}

TEST(Elementary, answers_for_what_is_out_of_range) {
    constexpr float no_number = std::numeric_limits<float>::quiet_NaN();
    constexpr float endless = std::numeric_limits<float>::infinity();
    CHECK_TRUE(std::isnan(elementary::sin(no_number)));
    CHECK_TRUE(std::isnan(elementary::sin(endless)));
    CHECK_TRUE(std::isnan(elementary::exp(no_number)));
    CHECK_TRUE(std::isnan(elementary::log(no_number)));
    CHECK_TRUE(std::isnan(elementary::log(-1.0F)));
    CHECK_TRUE(std::isnan(elementary::acos(1.001F)));
    CHECK_EQUAL(endless, elementary::exp(89.0F));
    CHECK_EQUAL(0.0F, elementary::exp(-endless));
    CHECK_EQUAL(-endless, elementary::log(0.0F));
    CHECK_EQUAL(endless, elementary::log(endless));
}

TEST(Elementary, leaves_other_types_to_the_library) {
    CHECK_EQUAL(std::sin(1.0), elementary::sin(1.0));
}
