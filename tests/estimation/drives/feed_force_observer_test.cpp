// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/feed_force_observer.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using millforce::estimation::FeedForceObserver;

TEST_GROUP(FeedForceObserver){};

// An axis of 250 kg and 120 N/A whose velocity swings: the current is what force and inertia ask for.
TEST(FeedForceObserver, finds_the_force_behind_the_inertia) {
    FeedForceObserver<float> observer({120.0F, 250.0F});
    for (int k = 0; k < 200; ++k) {
        const auto at = [](double t) { return 300.0 * std::sin(40.0 * t); };
        const double t = 1e-3 * k;
        const double velocity = 5.0 + 2.0 * std::sin(60.0 * t);
        const double acceleration = 120.0 * std::cos(60.0 * t);
        const double current = (at(t) + 250.0 * acceleration * 1e-3) / 120.0;
        const auto force = observer.add(1e-3F, static_cast<float>(current), static_cast<float>(velocity), 1.0F);
        CHECK(force.valid == (k >= 2));
        if (force.valid) {
            DOUBLES_EQUAL(at(t - 1e-3), static_cast<double>(force.value), 0.5);
        }
    }
}

TEST(FeedForceObserver, knows_no_force_of_an_axis_that_stands_or_turns_round) {
    FeedForceObserver<float> observer({120.0F, 250.0F});
    for (int k = 0; k < 5; ++k) {
        observer.add(1e-3F, 1.0F, 2.0F, 1.0F);
    }
    CHECK_FALSE(observer.add(1e-3F, 1.0F, 0.0F, 1.0F).valid);
    CHECK_FALSE(observer.add(1e-3F, 1.0F, 2.0F, 1.0F).valid);  // the difference would reach across the standstill
    CHECK_FALSE(observer.add(1e-3F, 1.0F, 2.0F, 1.0F).valid);
    CHECK(observer.add(1e-3F, 1.0F, 2.0F, 1.0F).valid);
    CHECK_FALSE(observer.add(1e-3F, 1.0F, -2.0F, 1.0F).valid);
}

TEST(FeedForceObserver, works_in_the_negative_direction_too) {
    FeedForceObserver<float> observer({120.0F, 250.0F});
    observer.add(1e-3F, -1.0F, -2.0F, -1.0F);
    observer.add(1e-3F, -1.0F, -2.0F, -1.0F);
    const auto force = observer.add(1e-3F, -1.0F, -2.0F, -1.0F);
    CHECK(force.valid);
    DOUBLES_EQUAL(-120.0, static_cast<double>(force.value), 1e-3);
}
