// SPDX-License-Identifier: Apache-2.0
#include "firmware/lone_fall.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using millforce::estimation::CutEstimate;
using LoneFall = millforce::firmware::LoneFall<float>;

namespace {

constexpr int settled = 64;
constexpr float whole_spindle_N = 300.0F;
constexpr float whole_axes_N = -150.0F;
/// What is believed before a fall is told from noise: 5 % of the F_at at first, and what the mean of a jump lags
/// behind.
constexpr double believed_first = 0.06;

/// A cut of unknown width, whose tooth force is at most twice F_at.
CutEstimate<float> cut_of(float share_of_spindle, float share_of_axes) {
    CutEstimate<float> e;
    e.tangential_N = {true, share_of_spindle * whole_spindle_N, 1.0F, 1.0F};
    e.feed_N = {true, share_of_axes * whole_axes_N, 0.0F, 0.0F};
    e.tooth_force_N = {true, 2.0F * e.tangential_N.value, 1.0F, 1.0F};
    e.tooth_force_is_bound = true;
    e.feed_per_tooth_mm = 0.1F;
    return e;
}

CutEstimate<float> with_known_width(CutEstimate<float> e) {
    e.tooth_force_is_bound = false;
    e.engagement.immersion_valid = true;
    e.engagement.radial_immersion_sd = 0.05F;
    return e;
}

float per_root_feed(const CutEstimate<float>& e) {
    return e.feed_per_tooth_mm > 0.0F ? 1.0F / std::sqrt(e.feed_per_tooth_mm) : 0.0F;
}

void follow(LoneFall& fall, const CutEstimate<float>& e, int times = 2 * settled) {
    for (int k = 0; k < times; ++k) {
        static_cast<void>(fall.largest_force_N(e, e.tooth_force_N.value, per_root_feed(e), true));
    }
}

LoneFall in_cut() {
    LoneFall fall;
    follow(fall, cut_of(1.0F, 1.0F));
    return fall;
}

double possible_N(LoneFall& fall, const CutEstimate<float>& e) {
    return static_cast<double>(fall.largest_force_N(e, e.tooth_force_N.value, per_root_feed(e), false));
}

}  // namespace

TEST_GROUP(LoneFall) {
    LoneFall fall = in_cut();
};

TEST(LoneFall, leaves_the_force_of_a_cut_that_does_not_change) {
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(1.0F, 1.0F)), 1e-3);
}

TEST(LoneFall, believes_no_force_that_fades_while_that_of_the_axes_stays) {
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.8F, 1.0F)), 600.0 * believed_first);
}

TEST(LoneFall, believes_a_cut_that_becomes_lighter_by_both_forces) {
    follow(fall, cut_of(0.8F, 0.8F));
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.8F, 0.8F)), 1e-3);
}

TEST(LoneFall, believes_a_lighter_cut_as_far_as_the_axes_show_it) {
    follow(fall, cut_of(0.7F, 0.9F));
    DOUBLES_EQUAL(540.0, possible_N(fall, cut_of(0.7F, 0.9F)), 540.0 * believed_first);
}

TEST(LoneFall, believes_an_axis_that_fades_and_one_that_carries_more) {
    follow(fall, cut_of(1.0F, 0.7F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(1.0F, 0.7F)), 1e-3);
    follow(fall, cut_of(1.0F, 1.2F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(1.0F, 1.2F)), 1e-3);
}

TEST(LoneFall, holds_no_more_than_was_there_where_the_axes_carry_more_and_the_spindle_less) {
    follow(fall, cut_of(0.8F, 1.4F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.8F, 1.4F)), 600.0 * believed_first);
}

TEST(LoneFall, lets_a_slower_feed_lower_the_force) {
    follow(fall, cut_of(0.8F, 1.0F));
    CutEstimate<float> slower = cut_of(0.4F, 1.0F);
    slower.feed_per_tooth_mm = 0.025F;
    DOUBLES_EQUAL(300.0, possible_N(fall, slower), 300.0 * believed_first);
}

TEST(LoneFall, sees_a_feed_that_halves_for_no_fall) {
    CutEstimate<float> slower = cut_of(std::sqrt(0.5F), std::sqrt(0.5F));
    slower.feed_per_tooth_mm = 0.05F;
    follow(fall, slower);
    DOUBLES_EQUAL(600.0 * std::sqrt(0.5), possible_N(fall, slower), 1e-3);
}

TEST(LoneFall, lowers_no_force) {
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(
        900.0,
        static_cast<double>(fall.largest_force_N(cut_of(0.8F, 1.0F), 900.0F, per_root_feed(cut_of(0.8F, 1.0F)), false)),
        1e-3);
}

TEST(LoneFall, compares_with_the_heaviest_cut_since_both_forces_last_changed_at_once) {
    follow(fall, cut_of(1.2F, 1.2F));
    follow(fall, cut_of(1.0F, 1.2F));
    DOUBLES_EQUAL(720.0, possible_N(fall, cut_of(1.0F, 1.2F)), 720.0 * believed_first);
    follow(fall, cut_of(0.5F, 0.6F));
    DOUBLES_EQUAL(300.0, possible_N(fall, cut_of(0.5F, 0.6F)), 1e-3);
    follow(fall, cut_of(0.4F, 0.6F));
    DOUBLES_EQUAL(300.0, possible_N(fall, cut_of(0.4F, 0.6F)), 300.0 * believed_first);
}

TEST(LoneFall, believes_a_lighter_cut_whose_friction_is_wrong_by_a_standard_deviation) {
    const auto with_wrong_friction = [](float share) {
        CutEstimate<float> e = cut_of(share, share);
        e.feed_N.value -= 50.0F;
        e.feed_N.variance = 2500.0F;
        return e;
    };
    LoneFall other;
    follow(other, with_wrong_friction(1.0F));
    follow(other, with_wrong_friction(0.8F));
    DOUBLES_EQUAL(480.0, possible_N(other, with_wrong_friction(0.8F)), 1e-3);
}

TEST(LoneFall, still_sees_a_fall_in_a_cut_that_has_slowly_become_half_as_heavy) {
    for (int percent = 100; percent > 50; --percent) {
        const float share = 0.01F * static_cast<float>(percent);
        follow(fall, cut_of(share, share), settled / 16);
    }
    follow(fall, cut_of(0.5F, 0.5F));
    follow(fall, cut_of(0.4F, 0.5F));
    DOUBLES_EQUAL(300.0, possible_N(fall, cut_of(0.4F, 0.5F)), 600.0 * believed_first);
}

TEST(LoneFall, takes_the_smallest_bound_that_was_found_before_the_fall) {
    CutEstimate<float> better_known = cut_of(1.0F, 1.0F);
    better_known.tooth_force_N.value = 500.0F;
    follow(fall, better_known);
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(500.0, possible_N(fall, cut_of(0.8F, 1.0F)), 500.0 * believed_first);
}

TEST(LoneFall, is_not_raised_by_a_bound_that_was_less_well_known_for_a_while) {
    CutEstimate<float> less_known = cut_of(1.0F, 1.0F);
    less_known.tooth_force_N.value = 800.0F;
    follow(fall, less_known);
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.8F, 1.0F)), 600.0 * believed_first);
}

TEST(LoneFall, sees_a_cut_that_pushes_the_axes_as_one_that_pulls_them) {
    LoneFall pushed;
    follow(pushed, cut_of(1.0F, -1.0F));
    follow(pushed, cut_of(0.8F, -1.0F));
    DOUBLES_EQUAL(600.0, possible_N(pushed, cut_of(0.8F, -1.0F)), 600.0 * believed_first);
}

TEST(LoneFall, leaves_a_narrower_cut_of_known_width_as_it_is) {
    const CutEstimate<float> narrower = with_known_width(cut_of(0.8F, 1.0F));
    follow(fall, narrower);
    DOUBLES_EQUAL(480.0, possible_N(fall, narrower), 1e-3);
    follow(fall, cut_of(0.64F, 1.0F));
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.64F, 1.0F)), 480.0 * believed_first);
}

TEST(LoneFall, takes_no_width_for_known_that_is_doubtful_or_leaves_the_force_a_bound) {
    CutEstimate<float> doubtful = with_known_width(cut_of(0.8F, 1.0F));
    doubtful.engagement.radial_immersion_sd = 0.3F;
    CutEstimate<float> none = with_known_width(cut_of(0.8F, 1.0F));
    none.engagement.immersion_valid = false;
    CutEstimate<float> bound = with_known_width(cut_of(0.8F, 1.0F));
    bound.tooth_force_is_bound = true;
    for (const CutEstimate<float>& e : {doubtful, none, bound}) {
        LoneFall other = in_cut();
        follow(other, e);
        DOUBLES_EQUAL(600.0, possible_N(other, e), 600.0 * believed_first);
    }
}

/// A spindle force that has faded looks like a narrow cut, and at its end that may be well known.
TEST(LoneFall, is_not_appeased_by_a_width_that_is_known_after_the_fall) {
    follow(fall, cut_of(0.8F, 1.0F));
    follow(fall, with_known_width(cut_of(0.7F, 1.0F)));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.7F, 1.0F)), 600.0 * believed_first);
}

TEST(LoneFall, is_over_when_the_spindle_carries_what_it_did) {
    follow(fall, cut_of(0.8F, 1.0F));
    follow(fall, cut_of(0.97F, 1.0F));
    DOUBLES_EQUAL(582.0, possible_N(fall, cut_of(0.97F, 1.0F)), 1e-2);
}

TEST(LoneFall, says_nothing_by_a_force_that_is_not_known) {
    follow(fall, cut_of(0.8F, 1.0F));
    CutEstimate<float> without_spindle = cut_of(0.8F, 1.0F);
    without_spindle.tangential_N.valid = false;
    CutEstimate<float> without_axes = cut_of(0.8F, 1.0F);
    without_axes.feed_N.valid = false;
    for (const CutEstimate<float>& e : {without_spindle, without_axes}) {
        DOUBLES_EQUAL(480.0, possible_N(fall, e), 1e-3);
    }
}

TEST(LoneFall, does_not_follow_what_is_not_known) {
    CutEstimate<float> without_spindle = cut_of(0.8F, 1.0F);
    without_spindle.tangential_N.valid = false;
    CutEstimate<float> without_axes = cut_of(0.8F, 1.0F);
    without_axes.feed_N.valid = false;
    CutEstimate<float> without_feed = cut_of(0.8F, 1.0F);
    without_feed.feed_per_tooth_mm = 0.0F;
    CutEstimate<float> without_tooth_force = cut_of(0.8F, 1.0F);
    without_tooth_force.tooth_force_N.valid = false;
    for (const CutEstimate<float>& e :
         {without_spindle, without_axes, without_feed, without_tooth_force, cut_of(0.0F, 1.0F)}) {
        LoneFall other = in_cut();
        follow(other, e);
        DOUBLES_EQUAL(480.0, possible_N(other, cut_of(0.8F, 1.0F)), 1e-3);
    }
}

TEST(LoneFall, keeps_its_doubt_over_an_estimate_without_feed) {
    follow(fall, cut_of(0.8F, 1.0F));
    CutEstimate<float> without_feed = cut_of(0.8F, 1.0F);
    without_feed.feed_per_tooth_mm = 0.0F;
    follow(fall, without_feed, 1);
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.8F, 1.0F)), 600.0 * believed_first);
}

TEST(LoneFall, knows_nothing_of_a_cut_before_its_first_estimates) {
    LoneFall fresh;
    follow(fresh, cut_of(1.0F, 1.0F), settled / 4);
    follow(fresh, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(480.0, possible_N(fresh, cut_of(0.8F, 1.0F)), 1.0);
}

TEST(LoneFall, hears_nothing_of_axes_whose_force_may_be_a_wrong_friction) {
    CutEstimate<float> lost_in_noise = cut_of(0.8F, 1.0F);
    lost_in_noise.feed_N.variance = 23000.0F;  // 152 N
    follow(fall, lost_in_noise);
    DOUBLES_EQUAL(480.0, possible_N(fall, lost_in_noise), 1e-3);
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.8F, 1.0F)), 1e-3);

    LoneFall never_heard;
    CutEstimate<float> whole = cut_of(1.0F, 1.0F);
    whole.feed_N.variance = lost_in_noise.feed_N.variance;
    follow(never_heard, whole);
    follow(never_heard, lost_in_noise);
    DOUBLES_EQUAL(480.0, possible_N(never_heard, cut_of(0.8F, 1.0F)), 1e-3);
}

TEST(LoneFall, outlasts_the_cut_until_the_currents_are_found_sound) {
    follow(fall, cut_of(0.8F, 1.0F));
    fall.leave_cut();
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(600.0, possible_N(fall, cut_of(0.8F, 1.0F)), 600.0 * believed_first);
    fall.clear();
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.8F, 1.0F)), 1e-3);
}

TEST(LoneFall, follows_no_cut_that_begins_or_ends) {
    for (int k = 0; k < 2 * settled; ++k) {
        static_cast<void>(fall.largest_force_N(cut_of(0.8F, 1.0F), 480.0F, per_root_feed(cut_of(0.8F, 1.0F)), false));
    }
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.8F, 1.0F)), 1e-3);
}

TEST(LoneFall, forgets_a_cut_without_a_fall_at_its_end) {
    fall.leave_cut();
    follow(fall, cut_of(0.8F, 1.0F));
    DOUBLES_EQUAL(480.0, possible_N(fall, cut_of(0.8F, 1.0F)), 1e-3);
}

TEST(LoneFall, hears_axes_that_still_cut_by_a_force_that_is_known_alone) {
    CutEstimate<float> e = cut_of(0.0F, 1.0F);
    CHECK_TRUE(fall.axes_still_cut(e, per_root_feed(e)));
    e.feed_N.valid = false;
    CHECK_FALSE(fall.axes_still_cut(e, per_root_feed(e)));
}
