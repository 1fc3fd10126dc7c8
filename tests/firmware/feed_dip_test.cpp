// SPDX-License-Identifier: Apache-2.0
#include "firmware/feed_dip.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "estimation/cut_estimate.hpp"

using FeedDip = millforce::firmware::FeedDip<float>;
using Answer = FeedDip::Answer;
using millforce::estimation::CutEstimate;

namespace {

constexpr float asked_mm_s = 10.0F;

/// Forces that follow the feed by the power 0.8, and what the currents have drifted by.
struct Cut {
    float tangential_N = 300.0F;
    float feed_N = 120.0F;
    float tangential_drift_N = 0.0F;
    float feed_drift_N = 0.0F;
    float growth_per_estimate = 0.0F;
    float axes_noise_N = 0.0F;
    float y_noise_N = 0.0F;
    int late = 2;                          // estimates until the axes follow a bound
    float most_per_estimate = asked_mm_s;  // that the feed changes by
    bool rises_again = true;
    bool is_disturbed = false;  // in each sixth estimate of the feed

    Answer answer(FeedDip& dip, int most = 200);
    int estimates = 0;
    int dipped = 0;  // of these, while the feed was down
    int risen = 0;   // and up again
    float feed_mm_s = asked_mm_s;
    float lowest_feed_mm_s = asked_mm_s;

  private:
    [[nodiscard]] CutEstimate<float> estimate() const {
        const float share =
            std::pow(feed_mm_s / asked_mm_s, 0.8F) * (1.0F + growth_per_estimate * static_cast<float>(estimates));
        CutEstimate<float> e;
        e.feed_mm_s = is_disturbed && estimates % 6 == 0 ? 1.1F * feed_mm_s : feed_mm_s;
        e.tangential_N = {true, tangential_N * share + tangential_drift_N, 1.0F, 1.0F};
        e.feed_N = {true, feed_N * share + feed_drift_N, 1.0F, 0.0F};
        e.x_N = {true, e.feed_N.value, 1.0F, axes_noise_N * axes_noise_N};
        e.y_N = {true, 0.0F, 1.0F, y_noise_N * y_noise_N};
        return e;
    }
};

Answer Cut::answer(FeedDip& dip, int most) {
    float bound_mm_s = dip.bound_mm_s();
    int since = 0;
    for (int k = 0; k < most; ++k) {
        ++estimates;
        if (dip.bound_mm_s() < bound_mm_s || dip.bound_mm_s() > bound_mm_s) {
            bound_mm_s = dip.bound_mm_s();
            since = 0;
        }
        if (++since > late) {
            const float followed_mm_s = rises_again ? bound_mm_s : std::fmin(bound_mm_s, feed_mm_s);
            feed_mm_s += std::clamp(followed_mm_s - feed_mm_s, -most_per_estimate, most_per_estimate);
        }
        lowest_feed_mm_s = std::fmin(lowest_feed_mm_s, feed_mm_s);
        const bool has_followed = std::fabs(feed_mm_s - bound_mm_s) < 0.01F;
        dipped += has_followed && bound_mm_s < asked_mm_s ? 1 : 0;
        risen += has_followed && !(bound_mm_s < asked_mm_s) && dipped > 0 ? 1 : 0;
        const Answer answer = dip.follow(estimate());
        if (answer != Answer::none || !dip.is_asking()) {
            return answer;
        }
    }
    return Answer::none;
}

Answer answer_of(Cut cut) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    return cut.answer(dip);
}

}  // namespace

TEST_GROUP(FeedDip){};

TEST(FeedDip, asks_nothing_and_bounds_nothing_by_itself) {
    const FeedDip dip;
    CHECK_FALSE(dip.is_asking());
    DOUBLES_EQUAL(0.0, static_cast<double>(dip.bound_mm_s()), 0.0);
}

TEST(FeedDip, finds_forces_alike_that_both_follow_the_feed) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    Cut cut;
    CHECK(cut.answer(dip) == Answer::alike);
    CHECK_FALSE(dip.is_asking());
    DOUBLES_EQUAL(0.7 * static_cast<double>(asked_mm_s), static_cast<double>(cut.lowest_feed_mm_s), 1e-4);
    DOUBLES_EQUAL(static_cast<double>(asked_mm_s), static_cast<double>(cut.feed_mm_s), 1e-4);
    CHECK_COMPARE(cut.estimates, <, 40);
}

TEST(FeedDip, finds_a_force_along_the_feed_unlike_that_has_drifted_by_more_than_a_sixth_of_the_other) {
    for (const float sign : {-1.0F, 1.0F}) {
        CHECK(answer_of({.feed_drift_N = sign * 30.0F}) == Answer::alike);
        CHECK(answer_of({.feed_drift_N = sign * 60.0F}) == Answer::unlike);
        CHECK(answer_of({.feed_N = -120.0F, .feed_drift_N = sign * 60.0F}) == Answer::unlike);
    }
}

TEST(FeedDip, finds_forces_unlike_where_the_spindles_current_has_lost_half) {
    CHECK(answer_of({.feed_N = 250.0F, .tangential_drift_N = -150.0F}) == Answer::unlike);
}

TEST(FeedDip, leaves_out_what_grows_steadily_meanwhile) {
    for (const float growth : {-0.005F, 0.005F}) {
        CHECK(answer_of({.growth_per_estimate = growth}) == Answer::alike);
        CHECK(answer_of({.feed_drift_N = -90.0F, .growth_per_estimate = growth}) == Answer::unlike);
    }
}

TEST(FeedDip, waits_for_a_cnc_that_is_late) {
    CHECK(answer_of({.late = 6}) == Answer::alike);
    CHECK(answer_of({.feed_drift_N = -90.0F, .late = 6}) == Answer::unlike);
}

TEST(FeedDip, dips_after_8_estimates_of_a_steady_feed) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    Cut cut;
    CHECK(cut.answer(dip, 7) == Answer::none);
    DOUBLES_EQUAL(10.0, static_cast<double>(dip.bound_mm_s()), 1e-4);
    CHECK(cut.answer(dip, 1) == Answer::none);
    DOUBLES_EQUAL(7.0, static_cast<double>(dip.bound_mm_s()), 1e-4);
}

TEST(FeedDip, measures_as_soon_as_the_feed_has_followed_and_is_steady) {
    for (Cut cut : {Cut{.late = 0}, Cut{.late = 6}, Cut{.most_per_estimate = 0.5F}}) {
        FeedDip dip;
        dip.ask(asked_mm_s);
        CHECK(cut.answer(dip) == Answer::alike);
        for (const int steady : {cut.dipped, cut.risen}) {
            CHECK_COMPARE(steady, >=, 8);
            CHECK_COMPARE(steady, <=, 12);
        }
    }
}

TEST(FeedDip, ends_also_where_the_feed_does_not_rise_again) {
    CHECK(answer_of({.rises_again = false}) == Answer::alike);
}

TEST(FeedDip, is_not_held_up_by_a_feed_that_is_disturbed_while_it_measures) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    Cut cut{.is_disturbed = true};
    CHECK(cut.answer(dip) == Answer::alike);
    CHECK_COMPARE(cut.estimates, <, 50);
}

TEST(FeedDip, finds_nothing_alike_in_noise_as_large_as_the_answer) {
    CHECK(answer_of({.axes_noise_N = 10.0F, .y_noise_N = 10.0F}) == Answer::alike);
    CHECK(answer_of({.axes_noise_N = 40.0F}) == Answer::unlike);
    CHECK(answer_of({.y_noise_N = 40.0F}) == Answer::unlike);
}

TEST(FeedDip, finds_nothing_alike_where_the_feed_does_not_follow) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    Cut cut{.late = 1000};
    CHECK(cut.answer(dip) == Answer::unlike);
    CHECK_COMPARE(cut.estimates, ==, 121);
    CHECK_FALSE(dip.is_asking());
}

TEST(FeedDip, dips_again_where_the_force_has_not_changed) {
    FeedDip dip;
    dip.ask(asked_mm_s);
    Cut cut{.tangential_N = 0.01F, .tangential_drift_N = 300.0F};
    CHECK(cut.answer(dip, 60) == Answer::none);
    CHECK_TRUE(dip.is_asking());
    CHECK(cut.answer(dip) == Answer::unlike);
}

TEST(FeedDip, ends_without_an_answer_where_a_force_is_not_known) {
    for (const bool spindle_is_known : {false, true}) {
        FeedDip dip;
        dip.ask(asked_mm_s);
        CutEstimate<float> e;
        e.tangential_N.valid = spindle_is_known;
        e.feed_N.valid = !spindle_is_known;
        CHECK(dip.follow(e) == Answer::none);
        CHECK_FALSE(dip.is_asking());
    }
}
