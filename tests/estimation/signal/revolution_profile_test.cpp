// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/revolution_profile.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

namespace {

using SmallProfile = millforce::estimation::RevolutionProfile<float, 128>;

double wave(double rev) {
    return 100.0 * std::sin(2.0 * std::numbers::pi * 3.0 * rev);
}

/// Turns evenly from `rev`, `step_rev` per sample, until the profile is whole; returns the samples it took.
int turn_until_whole(SmallProfile& profile, double& rev, double step_rev, int most) {
    for (int k = 1; k <= most; ++k) {
        rev += step_rev;
        const auto angle = static_cast<float>(rev - std::floor(rev));
        if (profile.add(angle, 1e-3F, static_cast<float>(wave(rev)), 7.0F)) {
            return k;
        }
    }
    return 0;
}

}  // namespace

TEST_GROUP(RevolutionProfile){};

TEST(RevolutionProfile, is_the_force_at_each_angle_whatever_the_sampling) {
    for (const double step_rev : {1.0 / 128.0, 1.0 / 301.7, 1.0 / 77.3}) {
        SmallProfile profile(2);
        double rev = 0.613;
        CHECK(turn_until_whole(profile, rev, step_rev, 2000) > 0);
        for (int bin = 0; bin < 128; ++bin) {
            DOUBLES_EQUAL(wave(bin / 128.0), static_cast<double>(profile.x_N(bin)), 1.5);
            DOUBLES_EQUAL(7.0, static_cast<double>(profile.y_N(bin)), 1e-4);
        }
        DOUBLES_EQUAL(1e-3 / (step_rev * 128.0), static_cast<double>(profile.seconds_per_bin()), 1e-6);
    }
}

TEST(RevolutionProfile, takes_the_revolutions_it_was_told) {
    SmallProfile one(1);
    SmallProfile four(4);
    double rev = 0.0;
    const int of_one = turn_until_whole(one, rev, 1.0 / 128.0, 2000);
    rev = 0.0;
    const int of_four = turn_until_whole(four, rev, 1.0 / 128.0, 2000);
    CHECK(of_one >= 128 && of_one <= 130);
    CHECK(of_four >= 512 && of_four <= 514);
}

TEST(RevolutionProfile, starts_anew_after_a_reversal_or_a_gap) {
    SmallProfile profile(1);
    double rev = 0.0;
    CHECK_EQUAL(0, turn_until_whole(profile, rev, 1.0 / 128.0, 100));
    profile.add(static_cast<float>(rev - 0.02), 1e-3F, 0.0F, 0.0F);  // backwards
    rev -= 0.02;
    CHECK_EQUAL(0, turn_until_whole(profile, rev, 1.0 / 128.0, 100));
    rev += 0.1;  // a tenth of a revolution was not seen
    CHECK_EQUAL(0, turn_until_whole(profile, rev, 1.0 / 128.0, 127));
    CHECK(turn_until_whole(profile, rev, 1.0 / 128.0, 5) > 0);
}

TEST(RevolutionProfile, goes_on_after_it_was_cleared) {
    SmallProfile profile(1);
    double rev = 0.2;
    turn_until_whole(profile, rev, 1.0 / 128.0, 200);
    profile.clear();
    CHECK_EQUAL(128, turn_until_whole(profile, rev, 1.0 / 128.0, 200));
}
