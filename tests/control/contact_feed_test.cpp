// SPDX-License-Identifier: Apache-2.0
#include "control/contact_feed.hpp"

#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

constexpr int block = 16;  // estimates that one answer is the mean of

void learn(ContactFeed<float>& feed, const Input& input, int estimates = block, const Parameters& p = {}) {
    for (int k = 0; k < estimates; ++k) {
        feed.learn(p, input);
    }
}

Input cut_with(float tooth_force_N, float turn_ratio = 1.0F) {
    Input input = in_contact();
    input.cut.tooth_force_N = tooth_force_N;
    input.cut.turn_ratio = turn_ratio;
    return input;
}

void check_force_at(const ContactFeed<float>& feed, float share, const Input& input, const Parameters& p) {
    const float slot_N = input.cut.turn_ratio * force_at(ratio_of(feed.feed_per_tooth_mm(), input), input);
    DOUBLES_EQUAL(static_cast<double>(share * p.tooth_force_limit_N), static_cast<double>(slot_N), 1.0);
}

}  // namespace

TEST_GROUP(ContactFeed){};

TEST(ContactFeed, is_unknown_before_a_settled_cut) {
    ContactFeed<float> feed;
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    learn(feed, in_contact(), block - 1);
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    learn(feed, in_contact(), 1);
    CHECK(feed.feed_per_tooth_mm() > 0.0F);
}

TEST(ContactFeed, brings_a_slot_of_the_same_depth_to_the_share_that_a_step_of_the_depth_leaves) {
    Parameters p;
    p.depth_step_ratio = 2.0F;
    p.depth_step_share = 1.5F;
    for (const float turn_ratio : {1.0F, 1.3F}) {
        ContactFeed<float> feed;
        const Input input = cut_with(600.0F, turn_ratio);
        learn(feed, input, block, p);
        check_force_at(feed, 0.75F, input, p);
    }
}

TEST(ContactFeed, is_that_of_the_heaviest_cut) {
    ContactFeed<float> feed;
    learn(feed, cut_with(500.0F));
    const float of_light_cut_mm = feed.feed_per_tooth_mm();
    learn(feed, cut_with(900.0F));
    const float of_heavy_cut_mm = feed.feed_per_tooth_mm();
    CHECK_COMPARE(of_heavy_cut_mm, <, of_light_cut_mm);
    learn(feed, cut_with(500.0F), 10 * block);
    DOUBLES_EQUAL(static_cast<double>(of_heavy_cut_mm), static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
}

TEST(ContactFeed, still_counts_a_cut_whose_slot_breaks_a_tooth_by_its_edge_force_alone) {
    ContactFeed<float> feed;
    Input too_heavy = cut_with(50'000.0F);
    too_heavy.cut.turn_cutting_share = 0.5F;
    learn(feed, too_heavy);
    const float least_mm = feed.feed_per_tooth_mm();
    CHECK(least_mm > 0.0F);
    learn(feed, cut_with(500.0F));
    DOUBLES_EQUAL(static_cast<double>(least_mm), static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
}

TEST(ContactFeed, learns_nothing_from_a_bound_a_guess_or_forces_that_contradict_the_law) {
    using Cut = CutEstimateForControl<float>;
    for (bool Cut::*const flag : {&Cut::tooth_force_is_bound, &Cut::law_is_refuted}) {
        Input input = in_contact();
        input.cut.*flag = true;
        ContactFeed<float> feed;
        learn(feed, input, 10 * block);
        DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    }
    Input guess = in_contact();
    guess.cut.tooth_force_valid = false;
    ContactFeed<float> feed;
    learn(feed, guess, 10 * block);
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    for (const float turn_ratio : {0.0F, -1.0F, not_a_number, beyond_all}) {
        learn(feed, cut_with(600.0F, turn_ratio), 10 * block);
        DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    }
}

TEST(ContactFeed, is_kept_over_cuts_that_the_law_of_the_feed_does_not_cover) {
    ContactFeed<float> feed;
    learn(feed, cut_with(500.0F));
    const float known_mm = feed.feed_per_tooth_mm();
    Input without_force = cut_with(5000.0F);
    without_force.cut.force_valid = false;
    Input without_share = cut_with(5000.0F);
    without_share.cut.turn_cutting_share = not_a_number;
    for (const Input& input : {without_force, without_share, cut_with(5000.0F, beyond_all)}) {
        learn(feed, input, 10 * block);
        DOUBLES_EQUAL(static_cast<double>(known_mm), static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    }
}

namespace {

void move_by(ContactFeed<float>& feed, float z_mm, bool height_is_known = true, bool rapid = true) {
    Input input = in_air();
    input.velocity_z_mm_s = z_mm > 0.0F ? 50.0F : -50.0F;
    input.height_is_known = height_is_known;
    input.rapid = rapid;
    feed.follow(input, z_mm / input.velocity_z_mm_s);
}

}  // namespace

TEST(ContactFeed, is_unknown_lower_than_the_tool_has_cut_and_known_again_after_a_cut_there) {
    ContactFeed<float> feed;
    learn(feed, in_contact());
    const float at_first_mm = feed.feed_per_tooth_mm();
    move_by(feed, 20.0F);
    DOUBLES_EQUAL(static_cast<double>(at_first_mm), static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    move_by(feed, -20.0F);
    DOUBLES_EQUAL(static_cast<double>(at_first_mm), static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    move_by(feed, -0.5F);
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    learn(feed, cut_with(900.0F));
    CHECK(feed.feed_per_tooth_mm() > 0.0F);
    CHECK_COMPARE(feed.feed_per_tooth_mm(), <, at_first_mm);
}

TEST(ContactFeed, counts_depth_from_the_lowest_cut_wherever_the_first_and_the_last_were) {
    ContactFeed<float> feed;
    move_by(feed, 5.0F);
    learn(feed, in_contact());
    move_by(feed, -0.5F);
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    learn(feed, in_contact());
    move_by(feed, 3.0F);
    learn(feed, in_contact());
    move_by(feed, -3.0F);
    CHECK(feed.feed_per_tooth_mm() > 0.0F);
}

TEST(ContactFeed, is_not_lost_by_the_drift_of_a_height_at_rest) {
    ContactFeed<float> feed;
    learn(feed, in_contact());
    Input drifting = in_air();
    drifting.velocity_z_mm_s = -0.04F;
    feed.follow(drifting, 60.0F);
    CHECK(feed.feed_per_tooth_mm() > 0.0F);
}

TEST(ContactFeed, is_forgotten_where_the_spindle_stands_or_the_motion_is_unseen) {
    for (const bool stands : {false, true}) {
        ContactFeed<float> feed;
        learn(feed, in_contact());
        Input input = in_air();
        input.cut.spindle_turning = !stands;
        input.motion_is_unseen = !stands;
        feed.follow(input, 0.001F);
        DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
    }
}

TEST(ContactFeed, does_not_outlast_a_rapid_whose_height_nobody_tells) {
    ContactFeed<float> feed;
    learn(feed, in_contact());
    move_by(feed, 1.0F, false, false);
    CHECK(feed.feed_per_tooth_mm() > 0.0F);
    move_by(feed, 1.0F, false);
    DOUBLES_EQUAL(0.0, static_cast<double>(feed.feed_per_tooth_mm()), 0.0);
}
