// SPDX-License-Identifier: Apache-2.0
#include "calibration/signal.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace millforce::host;

namespace {

std::vector<double> sine(double frequency_hz, double rate_hz, std::size_t n) {
    std::vector<double> signal(n);
    for (std::size_t k = 0; k < n; ++k) {
        signal[k] = std::sin(2.0 * std::numbers::pi * frequency_hz * static_cast<double>(k) / rate_hz);
    }
    return signal;
}

}  // namespace

TEST_GROUP(Signal){};

TEST(Signal, low_pass_keeps_phase_and_halves_at_its_cutoff) {
    const auto slow = sine(2.0, 1000.0, 4000);
    const auto kept = zero_phase_low_pass(slow, 20.0, 1000.0);
    const auto at_cutoff = zero_phase_low_pass(sine(20.0, 1000.0, 4000), 20.0, 1000.0);
    const auto stopped = zero_phase_low_pass(sine(100.0, 1000.0, 4000), 20.0, 1000.0);
    for (std::size_t k = 1000; k < 3000; ++k) {
        DOUBLES_EQUAL(slow[k], kept[k], 1e-4);
        DOUBLES_EQUAL(0.5 * sine(20.0, 1000.0, 4000)[k % 50], at_cutoff[k], 1e-3);
        DOUBLES_EQUAL(0.0, stopped[k], 1e-5);
        k += 97;
    }
}

TEST(Signal, low_pass_leaves_a_ramp_and_a_cutoff_beyond_the_rate_alone) {
    std::vector<double> ramp(500);
    for (std::size_t k = 0; k < ramp.size(); ++k) {
        ramp[k] = 3.0 + 0.1 * static_cast<double>(k);
    }
    const auto filtered = zero_phase_low_pass(ramp, 10.0, 1000.0);
    const auto unfiltered = zero_phase_low_pass(ramp, 600.0, 1000.0);
    for (std::size_t k = 0; k < ramp.size(); ++k) {
        DOUBLES_EQUAL(ramp[k], unfiltered[k], 0.0);
        DOUBLES_EQUAL(ramp[k], filtered[k], 0.02);
    }
}

TEST(Signal, derivative_of_a_sine_is_its_cosine_to_fourth_order) {
    const double omega = 2.0 * std::numbers::pi * 10.0;
    const auto slope = derivative(sine(10.0, 200.0, 400), 0.005);
    for (std::size_t k = 2; k < 398; ++k) {
        DOUBLES_EQUAL(omega * std::cos(omega * 0.005 * static_cast<double>(k)), slope[k], 0.004 * omega);
    }
    LONGS_EQUAL(3, derivative(std::vector<double>{1, 2, 3}, 1.0).size());
}

TEST(Signal, spikes_are_replaced_and_steps_and_noise_are_not) {
    std::mt19937 generator(6);
    std::normal_distribution<double> normal(0.0, 0.1);
    std::vector<double> clean(2000);
    for (std::size_t k = 0; k < clean.size(); ++k) {
        clean[k] = (k < 1000 ? 1.0 : 6.0) + normal(generator);
    }
    auto signal = clean;
    CHECK(replace_spikes(signal).empty());
    signal[300] = 40.0;
    signal[301] = -20.0;
    signal[1999] = 0.0;
    const auto places = replace_spikes(signal);
    CHECK(places == (std::vector<std::size_t>{300, 301, 1999}));
    DOUBLES_EQUAL(1.0, signal[300], 0.3);
    DOUBLES_EQUAL(1.0, signal[301], 0.3);
    DOUBLES_EQUAL(6.0, signal[1999], 0.3);
    DOUBLES_EQUAL(clean[302], signal[302], 0.0);
}

TEST(Signal, counts_correlated_samples_of_an_autoregressive_sequence) {
    std::mt19937 generator(5);
    std::normal_distribution<double> normal;
    for (const double rho : {0.0, 0.5, 0.9}) {
        std::vector<double> sequence(20'000);
        double last = 0.0;
        for (double& value : sequence) {
            last = rho * last + normal(generator);
            value = last;
        }
        const double expected = (1.0 + rho) / (1.0 - rho);
        DOUBLES_EQUAL(expected, correlated_samples(sequence), 0.15 * expected);
    }
}
