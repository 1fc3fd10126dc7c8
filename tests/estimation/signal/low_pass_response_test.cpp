// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/low_pass_response.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

using millforce::estimation::LowPassResponse;

TEST_GROUP(LowPassResponse){};

TEST(LowPassResponse, is_that_of_the_differential_equation) {
    for (const double damping : {0.3, 0.70710678, 0.95}) {
        const LowPassResponse<float> response{120.0F, static_cast<float>(damping)};
        const double omega = 2.0 * std::numbers::pi * 120.0;
        const double dt = 1e-7;
        double step = 0.0;
        double step_rate = 0.0;
        double ramp = 0.0;
        for (int k = 1; k <= 200000; ++k) {
            step_rate += dt * (omega * omega * (1.0 - step) - 2.0 * damping * omega * step_rate);
            step += dt * step_rate;
            ramp += dt * step;
            if (k % 20000 == 0) {
                const auto at = response.at(static_cast<float>(k * dt));
                DOUBLES_EQUAL(step, static_cast<double>(at.step), 1e-3);
                DOUBLES_EQUAL(ramp * omega, static_cast<double>(at.ramp_s) * omega, 2e-3);
            }
        }
    }
}

TEST(LowPassResponse, is_nothing_before_the_step_and_settled_when_it_says) {
    const LowPassResponse<float> response{};
    DOUBLES_EQUAL(0.0, static_cast<double>(response.at(-1e-3F).step), 0.0);
    DOUBLES_EQUAL(0.0, static_cast<double>(response.at(0.0F).ramp_s), 0.0);
    for (const float factor : {1.0F, 1.3F, 3.0F}) {
        DOUBLES_EQUAL(1.0, static_cast<double>(response.at(factor * response.settling_s()).step), 0.03);
    }
}

TEST(LowPassResponse, counts_only_what_its_band_lets_through_as_independent) {
    const LowPassResponse<float> response{};
    DOUBLES_EQUAL(1.0, static_cast<double>(response.independent_share(400.0F)), 1e-6);
    DOUBLES_EQUAL(0.5, static_cast<double>(response.independent_share(8000.0F) / response.independent_share(4000.0F)),
                  1e-5);
}
