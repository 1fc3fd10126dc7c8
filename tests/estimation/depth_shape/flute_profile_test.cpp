// SPDX-License-Identifier: Apache-2.0
#include "estimation/depth_shape/flute_profile_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace millforce::estimation;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;
using Profile = FluteProfile<float, 2, 180>;

/// A tooth's ripple on both channels, and a share that comes once per revolution.
Profile::Signals ripple(double rev, int teeth, double once_per_revolution) {
    Profile::Signals signals;
    signals << static_cast<float>(100.0 + 40.0 * std::cos(turn * rev * teeth) +
                                  once_per_revolution * std::cos(turn * rev)),
        static_cast<float>(-30.0 + 20.0 * std::sin(2.0 * turn * rev * teeth) +
                           once_per_revolution * std::sin(turn * rev));
    return signals;
}

/// Turns the spindle by steps until the profile is complete. The steps alternate by ± `unevenness`.
void turn_spindle(Profile& profile, int teeth, double step_rev, double unevenness, double once_per_revolution) {
    double rev = 0.123;
    for (int k = 0; k < 200000 && !profile.complete(); ++k) {
        const double step = step_rev * (k % 2 == 0 ? 1.0 + unevenness : 1.0 - unevenness);
        rev += step;
        profile.add(1e-3F, static_cast<float>(step), static_cast<float>(rev - std::floor(rev)),
                    ripple(rev, teeth, once_per_revolution));
    }
}

}  // namespace

TEST_GROUP(FluteProfile){};

TEST(FluteProfile, keeps_what_repeats_with_the_flutes_and_loses_what_comes_once_per_revolution) {
    for (const int teeth : {2, 3, 4, 6}) {
        Profile profile({.teeth = teeth, .revolutions = 20});
        turn_spindle(profile, teeth, 0.00137, 0.3, 50.0);
        CHECK_TRUE(profile.complete());
        const auto average = profile.average();
        for (std::size_t b = 0; b < average.mean.size(); ++b) {
            const double share = (static_cast<double>(b) + 0.5) / 180.0;
            DOUBLES_EQUAL(100.0 + 40.0 * std::cos(turn * share), static_cast<double>(average.mean[b][0]), 0.1);
            DOUBLES_EQUAL(-30.0 + 20.0 * std::sin(2.0 * turn * share), static_cast<double>(average.mean[b][1]), 0.1);
        }
    }
}

TEST(FluteProfile, does_not_mind_a_sampling_that_meets_each_tooth_at_the_same_places) {
    Profile profile({.teeth = 4, .revolutions = 20});
    turn_spindle(profile, 4, 1.0 / 96.0, 0.0, 0.0);  // 24 samples per pitch, always the same ones
    const auto spectrum = profile_spectrum<6>(profile.average());
    DOUBLES_EQUAL(20.0, static_cast<double>(spectrum.line[6 + 1].re), 0.4);
}

TEST(FluteProfile, gives_back_what_few_samples_take_from_a_harmonic) {
    Profile profile({.teeth = 4, .revolutions = 20});
    turn_spindle(profile, 4, 0.0153, 0.0, 30.0);  // 16 samples per pitch, that drift through it
    const auto average = profile.average();
    DOUBLES_EQUAL(0.25 / 0.0153, static_cast<double>(average.samples_per_pitch), 0.1);
    const auto spectrum = profile_spectrum<6>(average);
    // 40 cos x + i 20 sin 2x: lines ±1 hold 20, lines ±2 hold i(∓10i) = ±10.
    DOUBLES_EQUAL(20.0, static_cast<double>(spectrum.line[6 + 1].re), 0.1);
    DOUBLES_EQUAL(20.0, static_cast<double>(spectrum.line[6 - 1].re), 0.1);
    DOUBLES_EQUAL(10.0, static_cast<double>(spectrum.line[6 + 2].re), 0.1);
    DOUBLES_EQUAL(-10.0, static_cast<double>(spectrum.line[6 - 2].re), 0.1);
    DOUBLES_EQUAL(100.0, static_cast<double>(spectrum.line[6].re), 0.1);
    DOUBLES_EQUAL(-30.0, static_cast<double>(spectrum.line[6].im), 0.1);
}

TEST(FluteProfile, knows_the_spindles_speed) {
    Profile profile({.teeth = 4, .revolutions = 20});
    turn_spindle(profile, 4, 0.01, 0.0, 0.0);
    DOUBLES_EQUAL(10.0, static_cast<double>(profile.average().spindle_speed_rev_s), 0.01);
}

TEST(FluteProfile, starts_anew_after_a_gap_or_a_sample_that_is_no_number) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const bool gap : {true, false}) {
        Profile profile({.teeth = 4, .revolutions = 1});
        double rev = 0.0;
        const auto add = [&](double step, bool finite) {
            rev += step;
            Profile::Signals signals = ripple(rev, 4, 0.0);
            signals[1] = finite ? signals[1] : nan;
            return profile.add(1e-3F, static_cast<float>(step), static_cast<float>(rev - std::floor(rev)), signals);
        };
        for (int k = 0; k < 95; ++k) {
            CHECK_FALSE(add(0.01, true));
        }
        add(gap ? 0.2 : 0.01, gap);
        for (int k = 0; k < 95; ++k) {
            CHECK_FALSE(add(0.01, true));  // what was seen before the break does not count
        }
        for (int k = 0; k < 10; ++k) {
            add(0.01, true);
        }
        CHECK_TRUE(profile.complete());
        CHECK_TRUE(profile.average().mean[7].allFinite());
    }
}
