// SPDX-License-Identifier: Apache-2.0
#include "firmware/slow_fall.hpp"

#include <CppUTest/TestHarness.h>

using millforce::estimation::CutEstimate;
using SlowFall = millforce::firmware::SlowFall<float>;

namespace {

constexpr float period_s = 0.004F;
constexpr float drift_N_per_s = 100.0F;
constexpr int in_a_second = 250;

CutEstimate<float> cut_of(float tangential_N, float feed_per_tooth_mm = 0.1F) {
    CutEstimate<float> e;
    e.tooth_periods = 1;
    e.tangential_N = {true, tangential_N, 1.0F, 1.0F};
    e.feed_per_tooth_mm = feed_per_tooth_mm;
    return e;
}

/// From one force to another in so many seconds.
void go(SlowFall& fall, float from_N, float to_N, int seconds) {
    const int estimates = seconds * in_a_second;
    for (int k = 0; k <= estimates; ++k) {
        fall.follow(cut_of(from_N + (to_N - from_N) * static_cast<float>(k) / static_cast<float>(estimates)), period_s);
    }
}

double largest_N(const SlowFall& fall, const CutEstimate<float>& e) {
    return static_cast<double>(fall.largest_ratio(e) * e.tangential_N.value);
}

}  // namespace

TEST_GROUP(SlowFall){};

TEST(SlowFall, is_not_believed_as_fast_as_a_current_may_drift) {
    SlowFall fall(drift_N_per_s);
    go(fall, 400.0F, 400.0F, 1);
    go(fall, 400.0F, 250.0F, 3);
    DOUBLES_EQUAL(400.0, largest_N(fall, cut_of(250.0F)), 8.0);
}

TEST(SlowFall, hides_no_more_than_the_drift_where_the_force_falls_faster) {
    SlowFall fall(drift_N_per_s);
    go(fall, 600.0F, 600.0F, 1);
    go(fall, 600.0F, 200.0F, 1);
    const double hidden_N = largest_N(fall, cut_of(200.0F)) - 200.0;
    CHECK(hidden_N > 80.0);
    CHECK(hidden_N < 110.0);
}

TEST(SlowFall, is_taken_back_where_the_force_rises_again) {
    SlowFall fall(drift_N_per_s);
    go(fall, 400.0F, 400.0F, 1);
    go(fall, 400.0F, 350.0F, 1);
    go(fall, 350.0F, 450.0F, 2);
    DOUBLES_EQUAL(450.0, largest_N(fall, cut_of(450.0F)), 8.0);
}

TEST(SlowFall, is_not_seen_in_a_force_that_follows_the_feed) {
    SlowFall fall(drift_N_per_s);
    go(fall, 400.0F, 400.0F, 1);
    for (int k = 0; k < 2 * in_a_second; ++k) {
        fall.follow(cut_of(200.0F, 0.025F), period_s);
    }
    DOUBLES_EQUAL(1.0, static_cast<double>(fall.largest_ratio(cut_of(200.0F, 0.025F))), 0.01);
}

TEST(SlowFall, is_forgotten_where_the_current_is_found_to_be_sound) {
    SlowFall fall(drift_N_per_s);
    go(fall, 400.0F, 250.0F, 3);
    fall.clear();
    DOUBLES_EQUAL(250.0, largest_N(fall, cut_of(250.0F)), 1e-3);
}

TEST(SlowFall, says_nothing_of_a_force_or_a_feed_that_is_not_there) {
    SlowFall fall(drift_N_per_s);
    go(fall, 400.0F, 250.0F, 3);
    for (CutEstimate<float> e : {cut_of(0.0F), cut_of(250.0F, 0.0F)}) {
        fall.follow(e, period_s);
        DOUBLES_EQUAL(1.0, static_cast<double>(fall.largest_ratio(e)), 0.0);
    }
}

TEST(SlowFall, is_kept_over_estimates_without_a_force_or_a_feed) {
    CutEstimate<float> invalid = cut_of(100.0F);
    invalid.tangential_N.valid = false;
    for (const CutEstimate<float>& without : {cut_of(0.0F), cut_of(250.0F, 0.0F), invalid}) {
        SlowFall fall(drift_N_per_s);
        go(fall, 400.0F, 250.0F, 3);
        go(fall, 250.0F, 250.0F, 1);
        const double before_N = largest_N(fall, cut_of(250.0F));
        for (int k = 0; k < in_a_second; ++k) {
            fall.follow(without, period_s);
        }
        DOUBLES_EQUAL(before_N, largest_N(fall, cut_of(250.0F)), 1e-3);
    }
}
