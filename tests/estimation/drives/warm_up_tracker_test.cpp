// SPDX-License-Identifier: Apache-2.0
#include "estimation/drives/warm_up_tracker.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using millforce::estimation::Measurement;
using millforce::estimation::WarmUpTracker;

namespace {

using Tracker = WarmUpTracker<float>;

/// The cold spindle of the tests: 0.30 N·m above the warm one, 200 s; the machine's own is 0.36 N·m.
Tracker tracker(float time_constant_s = 200.0F) {
    return Tracker({0.4F, 1e-6F, 0.30F, 0.1F, time_constant_s});
}

Measurement<float> seen_in_air(double torque_Nm) {
    return {true, static_cast<float>(torque_Nm), 1e-4F, 1e-4F};
}

double cold_spindle_Nm(double time_s) {
    return 0.15 + 0.36 * std::exp(-time_s / 200.0);
}

void pass(Tracker& tracker, double duration_s) {
    for (double passed_s = 0.0; passed_s < duration_s; passed_s += 0.01) {
        tracker.predict(0.01F);
    }
}

double off(const Tracker& tracker, double truth) {
    return std::abs(static_cast<double>(tracker.value()) - truth);
}

}  // namespace

TEST_GROUP(WarmUpTracker){};

TEST(WarmUpTracker, falls_as_the_spindle_warms_up_after_one_zeroing_when_cold) {
    Tracker warming = tracker();
    Tracker without = tracker(0.0F);
    warming.correct(seen_in_air(cold_spindle_Nm(0.0)));
    without.correct(seen_in_air(cold_spindle_Nm(0.0)));
    pass(warming, 200.0);
    pass(without, 200.0);
    const double truth = cold_spindle_Nm(200.0);
    CHECK(off(warming, truth) < 0.06);
    CHECK(off(without, truth) > 0.2);
}

TEST(WarmUpTracker, states_a_deviation_that_covers_the_error) {
    Tracker warming = tracker();
    warming.correct(seen_in_air(cold_spindle_Nm(0.0)));
    for (double time_s = 50.0; time_s <= 600.0; time_s += 50.0) {
        pass(warming, 50.0);
        CHECK(off(warming, cold_spindle_Nm(time_s)) < 1.96 * std::sqrt(static_cast<double>(warming.variance())));
        CHECK(warming.variance() < 0.02F);  // and is worth having
    }
}

TEST(WarmUpTracker, learns_the_excess_from_zeroings_at_different_times) {
    Tracker learning = tracker();
    for (double time_s = 0.0; time_s < 300.0; time_s += 20.0) {
        learning.correct(seen_in_air(cold_spindle_Nm(time_s)));
        pass(learning, 20.0);
    }
    DOUBLES_EQUAL(0.36 * std::exp(-300.0 / 200.0), static_cast<double>(learning.excess()), 0.02);
    pass(learning, 300.0);
    CHECK(off(learning, cold_spindle_Nm(600.0)) < 0.02);
}

TEST(WarmUpTracker, finds_a_spindle_that_was_warm_when_the_controller_started) {
    Tracker warm({0.4F, 1e-6F, 0.30F, 0.3F, 200.0F});
    for (int k = 0; k < 15; ++k) {
        warm.correct(seen_in_air(0.15));
        pass(warm, 20.0);
    }
    CHECK(off(warm, 0.15) < 0.02);
    CHECK(std::abs(static_cast<double>(warm.excess())) < 0.02);
}

TEST(WarmUpTracker, keeps_its_variance_above_zero_and_ignores_what_is_no_measurement) {
    Tracker steady = tracker();
    for (int k = 0; k < 10000; ++k) {
        steady.correct({true, 0.2F, 1e-9F, 1e-9F});
        steady.predict(0.004F);
        CHECK(steady.variance() >= 0.0F);
    }
    const float before = steady.value();
    steady.correct({});
    CHECK(steady.value() == before);
    pass(steady, 1e4 / 100.0);
    CHECK(std::isfinite(steady.value()));
}
