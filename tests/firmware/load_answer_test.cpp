// SPDX-License-Identifier: Apache-2.0
#include "firmware/load_answer.hpp"

#include <CppUTest/TestHarness.h>

#include "firmware/tick_bench.hpp"

using millforce::estimation::CutEstimate;
using LoadAnswer = millforce::firmware::LoadAnswer<float>;
using namespace millforce::test;

namespace {

constexpr float period_s = 0.004F;
constexpr int in_a_second = 250;
constexpr float step_A = 0.1F;
constexpr bool is_settled = true;

/// F_at of 300 N at 10 mm/s, a tenth of it edge force: with 0.1 A + 2 · 0.02 A at 0.7 Nm/A and 5 mm the share is
/// A = 19.6 N/(300 N · 0.9 · 0.75) = 9.7 %.
constexpr float share = 0.0968F;

CutEstimate<float> cut_at(float feed, float tangential_N = 300.0F) {
    CutEstimate<float> e;
    e.tooth_periods = 1;
    e.tangential_N = {true, tangential_N, 1.0F, 1.0F};
    e.cutting_share = 0.9F;
    e.feed_exponent = 0.75F;
    e.feed_mm_s = feed;
    return e;
}

Parameters machine_with_a_seldom_load() {
    Parameters p = machine_and_tool();
    p.machine.spindle.current_sd_A = 0.02F;
    p.machine.spindle_load_period_s = 0.1F;
    return p;
}

}  // namespace

TEST_GROUP(LoadAnswer) {
    LoadAnswer answer{machine_with_a_seldom_load()};
    float reading_A = 4.0F;

    void follow(const CutEstimate<float>& e, int times = 1, bool settled = is_settled) {
        for (int k = 0; k < times; ++k) {
            answer.take(reading_A);
            answer.follow(e, period_s, settled);
        }
    }
    /// Two readings have taught the step; the last has just come.
    void learn_step() {
        follow(cut_at(10.0F));
        reading_A += step_A;
        follow(cut_at(10.0F));
    }
    void ask() {
        learn_step();
        follow(cut_at(10.0F), 2 * in_a_second + 1);
    }
    void is_bound_to(float feed) {
        DOUBLES_EQUAL(static_cast<double>(feed), static_cast<double>(answer.bound_mm_s()), 0.05);
    }
};

TEST(LoadAnswer, lets_the_feed_rise_by_no_more_than_the_reading_may_hide) {
    learn_step();
    is_bound_to(10.0F * (1.0F + share));
    follow(cut_at(10.9F), in_a_second);
    is_bound_to(10.0F * (1.0F + share));
}

TEST(LoadAnswer, of_another_reading_lets_the_feed_rise_from_where_it_is) {
    learn_step();
    reading_A += step_A;
    follow(cut_at(10.9F));
    is_bound_to(10.9F * (1.0F + share));
}

TEST(LoadAnswer, is_expected_from_the_feed_on_that_the_reading_belongs_to) {
    learn_step();
    reading_A += step_A;
    follow(cut_at(10.5F), 20, !is_settled);
    is_bound_to(0.0F);
    follow(cut_at(10.7F));
    is_bound_to(10.7F * (1.0F + share));
}

TEST(LoadAnswer, bounds_a_light_cut_less) {
    learn_step();
    follow(cut_at(10.0F, 150.0F));
    is_bound_to(10.0F * (1.0F + 2.0F * share));
}

TEST(LoadAnswer, is_asked_of_a_reading_that_stands_for_two_seconds_by_a_quarter_of_the_feed_each) {
    learn_step();
    follow(cut_at(10.0F), 2 * in_a_second - 2);
    is_bound_to(10.0F * (1.0F + share));
    follow(cut_at(10.0F), 4);
    is_bound_to(10.0F);
    follow(cut_at(10.0F), in_a_second / 2);
    is_bound_to(10.0F * (1.0F - 0.125F));
    follow(cut_at(10.0F), in_a_second);
    is_bound_to(10.0F * (1.0F - 2.5F * share));
}

TEST(LoadAnswer, begins_its_question_at_the_feed_of_that_moment) {
    learn_step();
    follow(cut_at(8.0F), 2 * in_a_second + 1);
    is_bound_to(8.0F);
}

TEST(LoadAnswer, ends_the_question) {
    ask();
    follow(cut_at(9.0F), in_a_second / 2);
    reading_A -= step_A;
    follow(cut_at(9.0F));
    is_bound_to(9.0F * (1.0F + share));
    CHECK_FALSE(answer.is_dead());
}

TEST(LoadAnswer, that_does_not_come_shows_a_dead_load) {
    ask();
    follow(cut_at(10.0F * (1.0F - 1.9F * share)), in_a_second);
    CHECK_FALSE(answer.is_dead());
    const CutEstimate<float> fallen = cut_at(10.0F * (1.0F - 2.1F * share));
    follow(fallen, in_a_second, !is_settled);
    CHECK_FALSE(answer.is_dead());
    follow(fallen);
    CHECK(answer.is_dead());
}

TEST(LoadAnswer, is_not_missed_where_the_law_alone_lowers_the_feed_of_a_cut_that_becomes_heavier) {
    learn_step();
    for (int k = 0; k < 2 * in_a_second - 1; ++k) {
        follow(cut_at(10.0F - 0.01F * static_cast<float>(k)));  // by half
    }
    follow(cut_at(5.0F), 2);
    CHECK_FALSE(answer.is_dead());
}

TEST(LoadAnswer, is_not_asked_of_a_cut_that_half_the_feed_would_not_show) {
    learn_step();
    const CutEstimate<float> light = cut_at(10.0F, 300.0F * share / 0.25F);
    follow(light, 9 * in_a_second);
    is_bound_to(10.0F * 1.25F);
    follow(cut_at(1.0F, light.tangential_N.value), in_a_second);
    CHECK_FALSE(answer.is_dead());
}

TEST(LoadAnswer, is_not_expected_before_a_step_of_the_load_was_seen) {
    follow(cut_at(10.0F), 9 * in_a_second);
    is_bound_to(0.0F);
    follow(cut_at(1.0F), in_a_second);
    CHECK_FALSE(answer.is_dead());
}

TEST(LoadAnswer, goes_by_the_smallest_step_up_or_down) {
    learn_step();
    reading_A -= 4.0F * step_A;
    follow(cut_at(10.0F));
    reading_A += 8.0F * step_A;
    follow(cut_at(10.0F));
    is_bound_to(10.0F * (1.0F + share));
    reading_A -= 0.5F * step_A;
    follow(cut_at(10.0F));
    is_bound_to(10.0F * (1.0F + share * 0.09F / 0.14F));
}

TEST(LoadAnswer, is_not_expected_without_a_force_to_change) {
    learn_step();
    for (const float tangential_N : {-300.0F, 0.0F, 1.0F}) {
        follow(cut_at(10.0F, tangential_N));
        is_bound_to(0.0F);
    }
}

TEST(LoadAnswer, is_asked_as_soon_as_a_reading_that_stands_has_a_force_to_show) {
    learn_step();
    follow(cut_at(10.0F, -300.0F), 3 * in_a_second);
    follow(cut_at(12.0F, -300.0F), in_a_second);
    follow(cut_at(12.0F));
    is_bound_to(12.0F);
}

TEST(LoadAnswer, is_not_expected_of_a_tool_without_a_diameter) {
    Parameters p = machine_with_a_seldom_load();
    p.tool.diameter_mm = 0.0F;
    answer = LoadAnswer(p);
    learn_step();
    is_bound_to(0.0F);
}

TEST(LoadAnswer, is_forgotten_out_of_the_cut) {
    ask();
    follow(cut_at(5.0F));
    CHECK(answer.is_dead());
    answer.restart();
    CHECK_FALSE(answer.is_dead());
    is_bound_to(0.0F);
    follow(cut_at(10.0F));
    is_bound_to(10.0F * (1.0F + share));
}

TEST(LoadAnswer, is_expected_of_no_current_that_comes_with_each_sample) {
    Parameters p = machine_with_a_seldom_load();
    p.machine.spindle_load_period_s = 0.0F;
    answer = LoadAnswer(p);
    ask();
    is_bound_to(0.0F);
    follow(cut_at(1.0F));
    CHECK_FALSE(answer.is_dead());
}
