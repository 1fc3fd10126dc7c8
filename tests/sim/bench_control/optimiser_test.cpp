// SPDX-License-Identifier: Apache-2.0
#include "bench_control/optimiser.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::sim;

TEST_GROUP(Minimise){};

TEST(Minimise, finds_the_bottom_of_a_bent_valley) {
    const auto valley = [](const std::vector<double>& at) {
        return 100.0 * std::pow(at[1] - at[0] * at[0], 2.0) + std::pow(1.0 - at[0], 2.0);  // Rosenbrock: 0 at (1, 1)
    };
    const Minimum found = minimise(valley, {{-2.0, 2.0, -1.2}, {-2.0, 2.0, 1.0}}, 300);
    DOUBLES_EQUAL(1.0, found.at[0], 0.05);
    DOUBLES_EQUAL(1.0, found.at[1], 0.10);
    CHECK_COMPARE(found.value, <, 1e-2);
}

TEST(Minimise, stays_within_its_ranges_and_its_number_of_evaluations) {
    int evaluations = 0;
    const auto slope = [&](const std::vector<double>& at) {
        ++evaluations;
        CHECK_COMPARE(at[0], >=, 0.4);
        CHECK_COMPARE(at[0], <=, 1.6);
        return at[0];
    };
    const Minimum found = minimise(slope, {{0.4, 1.6, 1.0}}, 40);
    DOUBLES_EQUAL(0.4, found.at[0], 1e-2);
    CHECK_COMPARE(evaluations, <=, 42);
    LONGS_EQUAL(evaluations, found.evaluations);
}

TEST(Minimise, takes_a_cost_with_a_step_in_it) {
    const auto fast_until_it_breaks = [](const std::vector<double>& at) { return at[0] > 0.83 ? 9.0 : -at[0]; };
    DOUBLES_EQUAL(0.83, minimise(fast_until_it_breaks, {{0.0, 1.0, 0.5}}, 60).at[0], 0.02);
}
