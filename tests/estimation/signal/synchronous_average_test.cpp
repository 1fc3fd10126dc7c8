// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/synchronous_average_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

namespace {

using Average = millforce::estimation::SynchronousAverage<float, 2, 1>;

/// Samples a spindle that turns evenly and carries a force ripple of one period per tooth.
struct Spindle {
    double revs_per_s;
    double sample_s;
    int teeth;
    double time_s = 0.0;

    static double force(double rev, int teeth) {
        return 100.0 + 60.0 * std::sin(2.0 * std::numbers::pi * rev * teeth) + 20.0 * std::cos(6.3 * rev * teeth);
    }
    int sample(Average& average, double step_s) {
        time_s += step_s;
        const double rev = revs_per_s * time_s;
        Average::Signals signals;
        signals << static_cast<float>(force(rev, teeth)), static_cast<float>(rev - std::floor(rev));
        return average.add(static_cast<float>(step_s), static_cast<float>(revs_per_s * step_s),
                           static_cast<float>(rev - std::floor(rev)), signals, 3U);
    }
    int sample(Average& average) { return sample(average, sample_s); }
};

}  // namespace

TEST_GROUP(SynchronousAverage){};

TEST(SynchronousAverage, of_a_constant_is_that_constant_at_any_ratio_of_rates) {
    for (const double revs_per_s : {0.7, 3.3, 21.0, 66.7, 166.0, 420.0}) {
        for (const int teeth : {1, 2, 3, 4, 7, 12}) {
            Average average({.teeth = teeth, .min_samples = 6.0F});
            double rev = 0.0;
            int periods = 0;
            for (int k = 0; k < 20000 && periods < 60; ++k) {
                rev += revs_per_s * 1e-3;
                Average::Signals signals;
                signals << 42.0F, -7.0F;
                periods += average.add(1e-3F, static_cast<float>(revs_per_s * 1e-3),
                                       static_cast<float>(rev - std::floor(rev)), signals, 3U);
            }
            const auto window = average.window();
            CHECK(window.revolutions >= 1);
            CHECK(window.samples >= 5.99F);
            DOUBLES_EQUAL(42.0, static_cast<double>(window.mean[0]), 5e-4);
            DOUBLES_EQUAL(1.0, static_cast<double>(window.spindle_speed_rad_s) / (revs_per_s * 2.0 * std::numbers::pi),
                          2e-3);
        }
    }
}

TEST(SynchronousAverage, removes_the_tooth_ripple_without_beating_against_the_sampling) {
    for (const double revs_per_s : {5.1, 12.3, 21.7, 33.3}) {
        Spindle spindle{revs_per_s, 1e-3, 3};
        Average average({.teeth = 3, .min_samples = 6.0F});
        double least = 1e9;
        double most = -1e9;
        for (int k = 0; k < 4000; ++k) {
            if (spindle.sample(average) > 0 && average.window().revolutions > 0) {
                const auto mean = static_cast<double>(average.window().mean[0]);
                least = std::min(least, mean);
                most = std::max(most, mean);
            }
        }
        // The second ripple is not periodic with the tooth (6.3 ≠ 2π): it alone remains.
        CHECK(most - least < 2.0);
        DOUBLES_EQUAL(100.0, 0.5 * (least + most), 1.5);
    }
}

TEST(SynchronousAverage, takes_windows_of_one_length_where_a_revolution_has_just_enough_samples) {
    constexpr int counts_per_rev = 1024;
    constexpr int samples_per_rev = 12;
    Average average({.teeth = 3, .min_samples = static_cast<float>(samples_per_rev)});
    int last_count = 0;
    int windows = 0;
    for (int k = 1; k < 6000; ++k) {
        const int count = counts_per_rev * k / samples_per_rev;
        const auto turned_rev = static_cast<float>(count - last_count) / static_cast<float>(counts_per_rev);
        last_count = count;
        const auto angle_rev = static_cast<float>(count % counts_per_rev) / static_cast<float>(counts_per_rev);
        if (average.add(1e-3F, turned_rev, angle_rev, Average::Signals::Zero(), 3U) > 0 && k > 100) {
            LONGS_EQUAL(1, average.window().revolutions);
            ++windows;
        }
    }
    CHECK(windows > 1000);
}

TEST(SynchronousAverage, gives_one_average_per_tooth_period) {
    Spindle spindle{10.0, 1e-3, 4};
    Average average({.teeth = 4, .min_samples = 6.0F});
    int periods = 0;
    for (int k = 0; k < 1000; ++k) {
        periods += spindle.sample(average);
    }
    CHECK(periods >= 38);
    CHECK(periods <= 40);
    DOUBLES_EQUAL(0.025, static_cast<double>(average.tooth().duration_s), 2e-4);
}

TEST(SynchronousAverage, bridges_a_lost_sample_but_not_a_lost_tooth) {
    Spindle spindle{10.0, 1e-3, 4};
    Average average({.teeth = 4, .min_samples = 6.0F});
    for (int k = 0; k < 300; ++k) {
        spindle.sample(average);
    }
    spindle.sample(average, 3e-3);  // two lost: 3 % of a revolution, an eighth of a tooth
    CHECK(average.window().revolutions > 0);
    spindle.sample(average);
    spindle.sample(average, 40e-3);  // more than a tooth was not seen
    CHECK(average.window().revolutions == 0);
    CHECK_FALSE(average.has_tooth());
}

TEST(SynchronousAverage, marks_a_signal_that_was_missing_in_any_sample) {
    Average average({.teeth = 1, .min_samples = 2.0F});
    double rev = 0.0;
    for (int k = 0; k < 64; ++k) {
        rev += 0.05;
        Average::Signals signals;
        signals << 1.0F, k == 50 ? std::nanf("") : 2.0F;
        average.add(1e-3F, 0.05F, static_cast<float>(rev - std::floor(rev)), signals, k == 50 ? 1U : 3U);
    }
    CHECK_EQUAL(1U, average.window().present & 3U);
    DOUBLES_EQUAL(1.0, static_cast<double>(average.window().mean[0]), 1e-5);
}

TEST(SynchronousAverage, sees_the_spindle_accelerate) {
    Average average({.teeth = 4, .min_samples = 24.0F});
    double speed = 20.0;
    double rev = 0.0;
    for (int k = 0; k < 400; ++k) {
        const double step = speed * 1e-3 + 0.5 * 5.0 * 1e-6;
        speed += 5.0 * 1e-3;
        rev += step;
        average.add(1e-3F, static_cast<float>(step), static_cast<float>(rev - std::floor(rev)),
                    Average::Signals::Zero(), 3U);
    }
    DOUBLES_EQUAL(5.0 * 2.0 * std::numbers::pi, static_cast<double>(average.window().spindle_acceleration_rad_s2), 3.0);
}

TEST(SynchronousAverage, knows_the_mean_rate_of_a_signal) {
    constexpr double revs_per_s = 66.7;
    constexpr double rate_per_s = 30.0;
    Average average({.teeth = 4, .min_samples = 12.0F});
    for (int k = 1; k <= 200; ++k) {
        const double time_s = 1e-3 * k;
        const double rev = revs_per_s * time_s;
        Average::Signals signals;
        signals << 42.0F, static_cast<float>(rate_per_s * time_s);
        average.add(1e-3F, static_cast<float>(revs_per_s * 1e-3), static_cast<float>(rev - std::floor(rev)), signals,
                    3U);
    }
    const auto window = average.window();
    CHECK(window.revolutions > 0);
    DOUBLES_EQUAL(rate_per_s, static_cast<double>(window.rate_per_s[0]), 0.01 * rate_per_s);
    DOUBLES_EQUAL(42.0, static_cast<double>(window.mean[0]), 1e-3);
}

TEST(SynchronousAverage, has_the_rate_right_where_a_signal_bends_within_the_window) {
    constexpr double revs_per_s = 50.0;
    constexpr double bend_s = 0.150;  // a quarter of the last window of 20 ms lies behind it
    const auto value_at = [](double time_s) { return time_s > bend_s ? 1000.0 * (time_s - bend_s) : 0.0; };
    Average average({.teeth = 4, .min_samples = 12.0F});
    for (int k = 1; k <= 156; ++k) {
        const double time_s = 1e-3 * k;
        const double rev = revs_per_s * time_s;
        Average::Signals signals;
        signals << 0.0F, static_cast<float>(value_at(time_s));
        average.add(1e-3F, static_cast<float>(revs_per_s * 1e-3), static_cast<float>(rev - std::floor(rev)), signals,
                    3U);
    }
    const auto window = average.window();
    CHECK_EQUAL(4, window.tooth_periods);
    DOUBLES_EQUAL(1000.0 * 5e-3 / 20e-3, static_cast<double>(window.rate_per_s[0]), 1.0);
}
