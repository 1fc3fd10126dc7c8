// SPDX-License-Identifier: Apache-2.0
#include "feed_ahead_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(FeedAheadGuards){};

TEST(FeedAheadGuards, in_mapped_air_without_contact_nothing_refutes_the_map) {
    Ahead ahead = with(wall);
    (void)cut(ahead, 5.0F, 15.0F, 3.0F);
    CHECK_FALSE(ahead.is_refuted());
    (void)ahead.step(estimate_at(15.1F, 100.0F));  // once alone may be noise
    (void)ahead.step(estimate_at(15.2F, 3.0F));
    (void)ahead.step(estimate_at(15.3F, 100.0F));
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, where_the_window_reaches_into_air_nothing_agrees_and_the_direction_is_that_of_the_cut) {
    Ahead ahead = with(wall);
    for (int k = 0; k < 50; ++k) {
        CHECK_FALSE(ahead.step(estimate_at(wall_mm + 0.2F, 300.0F)).known);
    }
    CHECK_FALSE(ahead.is_refuted());
    Ahead::Step sideways = estimate_at(wall_mm + 0.2F, 300.0F);
    sideways.feed_force_N = 0.0F;
    for (int k = 0; k < 10; ++k) {
        (void)ahead.step(sideways);
    }
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAheadGuards, close_to_the_end_of_the_map_its_last_stretch_is_expected) {
    FeedAheadSettings<float> settings = exact();
    settings.position_tolerance_mm = 1.0F;
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)}, settings);
    CHECK_TRUE(cut(ahead, 50.0F, 59.9F, 300.0F).known);
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, way_gone_where_the_position_is_not_known_agrees_with_nothing) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    Ahead::Step lost = at(std::numeric_limits<float>::quiet_NaN());
    lost.travel_mm = 0.4F;
    for (float s_mm = 1.0F; s_mm < 1.9F; s_mm += step_mm) {
        (void)ahead.step(lost);
        CHECK_FALSE(ahead.step(estimate_at(s_mm, 300.0F)).known);
    }
}

TEST(FeedAheadGuards, knows_nothing_in_a_step_of_which_one_value_is_not_finite) {
    for (float Ahead::Step::*const field :
         {&Ahead::Step::travel_mm, &Ahead::Step::dt_s, &Ahead::Step::feed_mm_s, &Ahead::Step::asked_feed_mm_s,
          &Ahead::Step::blind_feed_mm_s, &Ahead::Step::runout_mm_s, &Ahead::Step::mapped_runout_mm_s}) {
        for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
            CHECK_TRUE(cut(ahead, 1.0F, 10.0F, 300.0F).known);
            Ahead::Step now = estimate_at(10.1F, 300.0F);
            now.*field = value;
            CHECK_FALSE(ahead.step(now).known);
            CHECK_TRUE(ahead.step(estimate_at(10.2F, 300.0F)).known);
        }
    }
}

TEST(FeedAheadGuards, the_tooth_s_force_is_the_largest_of_the_window_wherever_it_stands) {
    FeedAheadSettings<float> settings = exact();
    settings.position_tolerance_mm = 1.0F;
    Ahead ahead = with({cut_from(0.0F), cut_from(20.0F, wall_feed_mm_s, 280.0F), air_from(60.0F)}, settings);
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    const WayAhead<float> way = ahead.step(estimate_at(20.3F, 288.0F));
    DOUBLES_EQUAL(2.0, static_cast<double>(way.tooth_per_tangential), 1e-6);
}

TEST(FeedAheadGuards, an_old_estimate_is_compared_with_nothing) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    CHECK_TRUE(cut(ahead, 1.0F, 10.0F, 300.0F).known);
    for (float s_mm = 10.1F; s_mm < 13.0F; s_mm += step_mm) {
        Ahead::Step old = estimate_at(s_mm, 1000.0F);
        old.fresh = false;
        CHECK_TRUE(ahead.step(old).known);
    }
}

TEST(FeedAheadGuards, an_estimate_without_a_window_expects_the_force_of_its_place) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    Ahead::Step now = estimate_at(10.1F, 300.0F);
    now.window_mm = 0.0F;
    DOUBLES_EQUAL(300.0, static_cast<double>(ahead.step(now).tangential_N), 0.5);
}

TEST(FeedAheadGuards, in_mapped_air_no_direction_is_expected) {
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)});
    Ahead::Step now = estimate_at(10.0F, 1000.0F);
    now.travel_mm = 1.0F;
    now.window_mm = 1.0F;
    (void)ahead.step(now);
    (void)ahead.step(now);  // a third that disagrees would refute the map
    now.position_mm = 30.0F;
    now.tangential_N = 100.0F;
    now.tangential_sd_N = 50.0F;
    now.feed_force_N = 90.0F;
    now.feed_force_sd_N = 1.0F;
    (void)ahead.step(now);
    CHECK_FALSE(ahead.is_refuted());
}

/// 300 N, of which 180 N at the edges of four teeth: 120 N and the edges of those that cut are there at least.
TEST(FeedAheadGuards, where_teeth_may_miss_the_cut_a_low_force_may_lack_their_edge_forces) {
    Stretch<float> with_edge_forces = cut_from(0.0F);
    with_edge_forces.falling_share = 0.4F;
    FeedAheadSettings<float> settings = exact(0.0F);
    settings.assumed_hardness = 1.5F;
    const auto hardness = [&](float runout_mm_s) {
        Ahead ahead = with({with_edge_forces, air_from(60.0F)}, settings);
        FeedAheadStep<float> now;
        for (float s_mm = 1.0F; s_mm < 20.0F; s_mm += step_mm) {
            now = estimate_at(s_mm, 225.0F);
            now.tangential_sd_N = 0.0F;
            now.runout_mm_s = runout_mm_s;
            now.mapped_runout_mm_s = runout_mm_s;
            now.tooth_share = 0.25F;
            (void)ahead.step(now);
        }
        return static_cast<double>(wall_feed_mm_s / ahead.step(now).feed_mm_s);
    };
    DOUBLES_EQUAL(225.0 / 300.0, hardness(9.0F), 1e-3);                    // all cut
    DOUBLES_EQUAL(225.0 / (120.0 + 0.4 * 180.0), hardness(15.0F), 1e-3);   // 10/(10 + 15)
    DOUBLES_EQUAL(225.0 / (120.0 + 0.25 * 180.0), hardness(90.0F), 1e-3);  // one
}

TEST(FeedAheadGuards, a_force_below_contact_agrees_with_no_cut) {
    Ahead ahead = with({cut_from(0.0F, wall_feed_mm_s, 50.0F), air_from(60.0F)});
    CHECK_FALSE(cut(ahead, 1.0F, 10.0F, 15.0F).known);
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, below_contact_the_direction_of_the_force_says_nothing) {
    Ahead ahead = with({cut_from(0.0F, wall_feed_mm_s, 50.0F), air_from(60.0F)});
    for (float s_mm = 1.0F; s_mm < 3.0F; s_mm += step_mm) {
        Ahead::Step now = estimate_at(s_mm, 15.0F);
        now.feed_force_N = -100.0F;
        (void)ahead.step(now);
    }
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, a_force_along_the_feed_far_above_that_of_the_map_refutes_it) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    for (float s_mm = 1.0F; s_mm < 10.0F; s_mm += step_mm) {
        Ahead::Step now = estimate_at(s_mm, 300.0F);
        now.feed_force_N = 2.0F * now.tangential_N;
        (void)ahead.step(now);
    }
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAheadGuards, nothing_is_left_of_a_map_after_a_restart) {
    Ahead ahead(exact());
    for (float begin_mm = 0.0F; ahead.room() > 0; begin_mm += 1.0F) {
        CHECK_TRUE(ahead.add(cut_from(begin_mm)));
    }
    ahead.restart();
    DOUBLES_EQUAL(static_cast<double>(WayAhead<float>{}.feed_mm_s), static_cast<double>(ahead.step(at(5.0F)).feed_mm_s),
                  0.0);
}

TEST(FeedAheadGuards, a_stretch_that_is_passed_is_expected_no_more) {
    Ahead ahead = with({cut_from(0.0F, wall_feed_mm_s, 400.0F), cut_from(20.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 400.0F);
    DOUBLES_EQUAL(300.0, static_cast<double>(ahead.step(estimate_at(30.0F, 300.0F)).tangential_N), 0.5);
}

TEST(FeedAheadGuards, air_is_passed_at_its_feed_whatever_the_material) {
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), cut_from(90.0F), air_from(100.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 360.0F);
    DOUBLES_EQUAL(1.2, static_cast<double>(ahead.hardness()), 1e-3);
    DOUBLES_EQUAL(static_cast<double>(air_feed_mm_s), static_cast<double>(ahead.step(at(50.0F)).feed_mm_s), 1e-3);
}

TEST(FeedAheadGuards, refuses_a_stretch_whose_share_or_softness_cannot_be) {
    Ahead ahead = with({cut_from(0.0F)});
    for (const float share : {0.0F, -0.5F, 1.1F}) {
        Stretch<float> stretch = cut_from(1.0F);
        stretch.falling_share = share;
        CHECK_FALSE(ahead.add(stretch));
    }
    for (const float softness : {0.0F, -1.0F}) {
        Stretch<float> stretch = cut_from(1.0F);
        stretch.feed_per_softness = softness;
        CHECK_FALSE(ahead.add(stretch));
    }
    CHECK_TRUE(ahead.add(cut_from(1.0F)));
}

TEST(FeedAheadGuards, a_material_that_is_too_hard_for_a_stretch_stops_the_feed_there) {
    Stretch<float> edge = cut_from(20.0F);
    edge.feed_per_softness = 10.0F;
    Ahead ahead = with({cut_from(0.0F), edge, air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 360.0F);
    DOUBLES_EQUAL(0.0, static_cast<double>(ahead.step(at(30.0F)).feed_mm_s), 1e-3);
}

TEST(FeedAheadGuards, an_estimate_at_a_feed_that_is_not_known_is_compared_with_nothing) {
    for (const float feed_mm_s : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
        Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
        CHECK_TRUE(cut(ahead, 1.0F, 10.0F, 300.0F).known);
        for (float s_mm = 10.1F; s_mm < 13.0F; s_mm += step_mm) {
            CHECK_TRUE(ahead.step(estimate_at(s_mm, 300.0F, feed_mm_s)).known);
        }
    }
}

TEST(FeedAheadGuards, refuses_a_first_stretch_that_begins_nowhere) {
    for (const float begin_mm : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Ahead ahead = with({});
        CHECK_FALSE(ahead.add(cut_from(begin_mm)));
    }
}

TEST(FeedAheadGuards, refuses_a_stretch_whose_least_force_is_none_of_its_force) {
    Ahead ahead = with({cut_from(0.0F)});
    for (const float share : {-0.1F, 1.1F, std::numeric_limits<float>::quiet_NaN()}) {
        Stretch<float> stretch = cut_from(1.0F);
        stretch.least_share = share;
        CHECK_FALSE(ahead.add(stretch));
    }
}

TEST(FeedAheadGuards, an_estimate_whose_window_is_not_known_confirms_nothing) {
    for (const float window_mm : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
        Ahead::Step now = estimate_at(10.0F, 300.0F);
        now.window_mm = window_mm;
        now.travel_mm = 3.0F;
        CHECK_FALSE(ahead.step(now).known);
    }
}

TEST(FeedAheadGuards, an_estimate_confirms_no_more_than_its_window) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    for (float s_mm = 1.0F; s_mm < 10.0F; s_mm += step_mm) {
        Ahead::Step old = estimate_at(s_mm, 300.0F);
        old.fresh = false;
        (void)ahead.step(old);
    }
    CHECK_FALSE(ahead.step(estimate_at(10.1F, 300.0F)).known);
}

TEST(FeedAheadGuards, two_estimates_that_disagree_over_a_long_way_refute_nothing_nor_many_over_a_short_one) {
    Ahead::Step wrong = estimate_at(10.0F, 1000.0F);
    wrong.window_mm = 1.0F;
    wrong.travel_mm = 1.0F;
    Ahead in_a_rapid = with({cut_from(0.0F), air_from(60.0F)});
    (void)in_a_rapid.step(wrong);
    (void)in_a_rapid.step(wrong);
    CHECK_FALSE(in_a_rapid.is_refuted());
    (void)in_a_rapid.step(wrong);
    CHECK_TRUE(in_a_rapid.is_refuted());
    wrong.travel_mm = 0.01F;
    Ahead slow = with({cut_from(0.0F), air_from(60.0F)});
    for (int k = 0; k < 40; ++k) {
        (void)slow.step(wrong);
    }
    CHECK_FALSE(slow.is_refuted());
}

TEST(FeedAheadGuards, in_mapped_air_a_force_below_contact_refutes_nothing_however_well_it_is_known) {
    Ahead ahead = with(wall);
    for (float s_mm = 5.0F; s_mm < 15.0F; s_mm += step_mm) {
        Ahead::Step now = estimate_at(s_mm, 15.0F);
        now.tangential_sd_N = 0.1F;
        (void)ahead.step(now);
    }
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, a_force_in_mapped_air_that_may_be_noise_confirms_nothing) {
    Ahead ahead = with(wall);
    Ahead::Step now = estimate_at(10.0F, 100.0F);
    now.tangential_sd_N = 50.0F;
    CHECK_FALSE(ahead.step(now).known);
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, a_runout_above_the_feed_of_the_map_leaves_one_tooth_the_chips_of_all) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    Ahead::Step now = at(10.1F);
    now.runout_mm_s = 90.0F;
    now.tooth_share = 0.25F;
    DOUBLES_EQUAL(0.25 * static_cast<double>(wall_feed_mm_s), static_cast<double>(ahead.step(now).feed_mm_s), 1e-3);
}

TEST(FeedAheadGuards, a_tool_that_brakes_passes_no_place_that_it_may_still_stand_before) {
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)}, exact(0.1F));
    Ahead::Step now = at(19.4F);
    now.dt_s = 1.0F;
    now.feed_mm_s = 10.0F;  // and 0 is asked for: half a reaction time of way is left, half of it surely
    DOUBLES_EQUAL(static_cast<double>(wall_feed_mm_s), static_cast<double>(ahead.step(now).feed_mm_s), 1e-3);
}

TEST(FeedAheadGuards, the_machine_is_thought_to_follow_another_feed_no_faster_than_it_can) {
    for (const float asked_mm_s : {0.0F, air_feed_mm_s}) {
        Ahead ahead = with(wall, exact(0.1F));
        Ahead::Step now = at(wall_mm - 4.0F);
        now.dt_s = 1.0F;
        now.feed_mm_s = now.asked_feed_mm_s = wall_feed_mm_s;
        const float before_mm_s = ahead.step(now).feed_mm_s;
        now.dt_s = 0.01F;
        now.asked_feed_mm_s = asked_mm_s;
        DOUBLES_EQUAL(before_mm_s, ahead.step(now).feed_mm_s, 0.03 * static_cast<double>(before_mm_s));
    }
}

// ---- Behind what the map does not know
// ------------------------------------------------------------------------------

namespace {

Stretch<float> unknown_from(float begin_mm) {
    Stretch<float> stretch = cut_from(begin_mm);
    stretch.is_known = false;
    return stretch;
}

Ahead with_a_cut_from_20_mm_behind(const Stretch<float>& first) {
    return with({first, cut_from(20.0F), air_from(60.0F)});
}

}  // namespace

TEST(FeedAheadGuards, a_cut_that_the_map_does_not_know_teaches_nothing_of_the_material) {
    Ahead ahead = with_a_cut_from_20_mm_behind(unknown_from(0.0F));
    (void)cut(ahead, 1.0F, 19.0F, 300.0F);
    DOUBLES_EQUAL(0.0, static_cast<double>(ahead.hardness()), 0.0);
}

TEST(FeedAheadGuards, where_the_window_reaches_into_what_is_not_known_any_force_agrees) {
    Ahead ahead = with_a_cut_from_20_mm_behind(unknown_from(0.0F));
    for (int k = 0; k < 10; ++k) {
        (void)ahead.step(estimate_at(20.2F, 900.0F));
    }
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadGuards, where_the_window_reaches_into_an_entry_neither_direction_nor_tooth_are_known) {
    Stretch<float> entry = cut_from(0.0F);
    entry.least_share = 0.0F;
    Ahead ahead = with_a_cut_from_20_mm_behind(entry);
    Ahead::Step sideways = estimate_at(20.2F, 250.0F);
    sideways.feed_force_N = -250.0F;
    WayAhead<float> way;
    for (int k = 0; k < 10; ++k) {
        way = ahead.step(sideways);
    }
    CHECK_FALSE(ahead.is_refuted());
    DOUBLES_EQUAL(0.0, static_cast<double>(way.tooth_per_tangential), 0.0);
    CHECK_COMPARE(ahead.step(estimate_at(20.6F, 300.0F)).tooth_per_tangential, >, 0.0F);
}

TEST(FeedAheadGuards, is_not_known_as_near_to_what_is_not_known_as_the_map_may_be_off) {
    FeedAheadSettings<float> settings = exact();
    settings.farthest_off_mm = 2.0F;
    Ahead ahead = with({cut_from(0.0F), unknown_from(10.0F), cut_from(20.0F), air_from(60.0F)}, settings);
    CHECK_TRUE(cut(ahead, 1.0F, 7.9F, 300.0F).known);
    for (const float position_mm : {8.1F, 15.0F, 21.9F}) {
        CHECK_FALSE(ahead.step(at(position_mm)).known);
    }
    CHECK_TRUE(ahead.step(at(22.1F)).known);
}

/// What the tick learns as idle torque depends on it.
TEST(FeedAheadGuards, a_cut_may_be_where_the_map_has_one_before_forces_have_confirmed_it_and_until_they_refute_it) {
    Ahead ahead = with({air_from(0.0F), cut_from(20.0F), air_from(60.0F)});
    CHECK_FALSE(ahead.step(estimate_at(10.0F, 0.0F)).may_cut);
    const WayAhead<float> in_cut = ahead.step(estimate_at(30.0F, 0.0F));
    CHECK_TRUE(in_cut.may_cut);
    CHECK_FALSE(in_cut.known);
    (void)cut(ahead, 30.1F, 40.0F, 0.0F);
    CHECK_TRUE(ahead.is_refuted());
    CHECK_FALSE(ahead.step(at(41.0F)).may_cut);
}
