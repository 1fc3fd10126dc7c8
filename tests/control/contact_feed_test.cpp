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
