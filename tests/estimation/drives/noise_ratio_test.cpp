// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/noise_ratio.hpp"

#include <CppUTest/TestHarness.h>

#include <random>

using namespace millforce::estimation;

namespace {

/// Changes with this standard deviation, where the drive's parameters say 1 N.
void learn(NoiseRatio<double>& noise, double true_sd_N, int changes, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> change_N(0.0, true_sd_N);
    for (int k = 0; k < changes; ++k) {
        const double variance = noise.value();
        noise.learn({true, change_N(random), variance, variance});
    }
}

double learnt(double true_sd_N, int changes) {
    NoiseRatio<double> noise;
    learn(noise, true_sd_N, changes);
    return noise.value();
}

/// Of 2000 currents, how many pass for as noisy as stated.
int as_stated(double true_sd_N, int changes) {
    int count = 0;
    for (unsigned seed = 1; seed <= 2000; ++seed) {
        NoiseRatio<double> noise;
        learn(noise, true_sd_N, changes, seed);
        count += noise.is_as_stated() ? 1 : 0;
    }
    return count;
}

}  // namespace

TEST_GROUP(NoiseRatio){};

TEST(NoiseRatio, learns_the_variance_of_a_current_that_is_noisier_than_told) {
    DOUBLES_EQUAL(9.0, learnt(3.0, 200), 3.0);
}

TEST(NoiseRatio, keeps_to_what_is_told_where_the_current_is_less_noisy) {
    DOUBLES_EQUAL(1.0, learnt(0.3, 200), 1e-12);
}

TEST(NoiseRatio, lets_one_outlier_count_no_more_than_three_standard_deviations) {
    NoiseRatio<double> noise;
    noise.learn({true, 1e6, 1.0, 1.0});
    DOUBLES_EQUAL(1.0 + 8.0 / 9.0, noise.value(), 1e-12);
}

TEST(NoiseRatio, learns_nothing_without_a_change_or_its_variance) {
    NoiseRatio<double> noise;
    noise.learn({false, 100.0, 1.0, 1.0});
    noise.learn({true, 100.0, 0.0, 0.0});
    DOUBLES_EQUAL(1.0, noise.value(), 1e-12);
}

TEST(NoiseRatio, follows_a_current_that_becomes_noisier_after_hours) {
    NoiseRatio<double> noise;
    learn(noise, 1.0, 100'000);
    learn(noise, 3.0, 200);
    DOUBLES_EQUAL(9.0, noise.value(), 3.0);
}

TEST(NoiseRatio,
     takes_a_sound_current_for_a_weak_one_in_less_than_one_of_200_cases_and_one_of_a_third_nearly_never_for_sound) {
    CHECK(as_stated(1.0, 200) > 1990);
    CHECK(as_stated(0.5, 200) <= 700);
    CHECK(as_stated(0.3, 200) < 10);
}
