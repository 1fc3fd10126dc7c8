// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/noise_ratio.hpp"

#include <CppUTest/TestHarness.h>

#include <random>

using namespace millforce::estimation;

namespace {

/// What NoiseRatio learns from changes with this standard deviation, where the drive's parameters say 1 N.
double learnt(double true_sd_N, int changes) {
    std::mt19937 random(1);
    std::normal_distribution<double> change_N(0.0, true_sd_N);
    NoiseRatio<double> noise;
    for (int k = 0; k < changes; ++k) {
        const double variance = noise.value();
        noise.learn({true, change_N(random), variance, variance});
    }
    return noise.value();
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
