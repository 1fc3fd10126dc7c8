// SPDX-License-Identifier: Apache-2.0
#include "feed_ahead_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <initializer_list>
#include <limits>
#include <vector>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

float feed_of_map_at(const std::vector<Stretch<float>>& stretches, float position_mm) {
    float feed_mm_s = stretches.front().feed_mm_s;
    for (const Stretch<float>& stretch : stretches) {
        feed_mm_s = stretch.begin_mm <= position_mm ? stretch.feed_mm_s : feed_mm_s;
    }
    return feed_mm_s;
}

struct Drive {
    float highest_excess = 0.0F;  ///< feed over the map's at the same place
    float time_s = 0.0F;
};

/// A machine that starts to follow each answer `reaction_s` later, with the acceleration that was declared. The answers
/// come once a millisecond, which is part of the reaction.
Drive drive_along(const std::vector<Stretch<float>>& stretches, float reaction_s, float told_reaction_s) {
    constexpr float dt_s = 0.001F;
    const FeedAheadSettings<float> settings = exact(told_reaction_s);
    Ahead ahead = with(stretches, settings);
    std::deque<float> on_its_way(static_cast<std::size_t>(std::lround(reaction_s / dt_s)) - 1, 0.0F);
    Drive drive;
    float position_mm = 0.0F;
    float feed_mm_s = 0.0F;
    const float largest_change = settings.acceleration_mm_s2 * dt_s;
    while (position_mm < stretches.back().begin_mm - 1.0F && drive.time_s < 60.0F) {
        Ahead::Step now = at(position_mm);
        now.dt_s = dt_s;
        now.feed_mm_s = feed_mm_s;
        now.asked_feed_mm_s = on_its_way.back();
        on_its_way.push_back(ahead.step(now).feed_mm_s);
        feed_mm_s += std::clamp(on_its_way.front() - feed_mm_s, -largest_change, largest_change);
        on_its_way.pop_front();
        position_mm += feed_mm_s * dt_s;
        drive.time_s += dt_s;
        drive.highest_excess = std::max(drive.highest_excess, feed_mm_s / feed_of_map_at(stretches, position_mm));
    }
    return drive;
}

Drive drive_along(const std::vector<Stretch<float>>& stretches, float reaction_s) {
    return drive_along(stretches, reaction_s, reaction_s);
}

}  // namespace

TEST_GROUP(FeedAhead){};

TEST(FeedAhead, a_machine_that_brakes_as_it_is_told_passes_the_wall_at_the_walls_feed) {
    for (const float reaction_s : {0.01F, 0.05F, 0.1F}) {
        const Drive drive = drive_along(wall, reaction_s);
        CHECK_COMPARE(drive.highest_excess, <=, 1.01F);
        // 3.5 mm of braking from 60 to 10 mm/s; the first answer comes a reaction time after the begin. Two reaction
        // times are lost by braking early enough.
        const double reaction = static_cast<double>(reaction_s);
        const double soonest_s = reaction + 0.12 / 2.0 + 36.5 / 60.0 + 0.1 + 59.0 / 10.0;
        CHECK_COMPARE(static_cast<double>(drive.time_s), >, soonest_s - 0.02);
        CHECK_COMPARE(static_cast<double>(drive.time_s), <, soonest_s + 2.0 * reaction + 0.02);
    }
}

TEST(FeedAhead, far_from_the_wall_the_air_is_passed_at_its_own_feed) {
    Ahead ahead = with(wall);
    DOUBLES_EQUAL(60.0, static_cast<double>(ahead.step(at(10.0F)).feed_mm_s), 1e-3);
}

TEST(FeedAhead, a_machine_is_never_faster_than_the_map_whatever_lies_ahead) {
    std::vector<Stretch<float>> ramp;
    for (float s_mm = 0.0F; s_mm < 60.0F; s_mm += 0.5F) {
        ramp.push_back(cut_from(s_mm, 50.0F - 0.6F * s_mm));
    }
    ramp.push_back(air_from(60.0F));
    const std::vector<Stretch<float>> gap = {cut_from(0.0F), air_from(20.0F), cut_from(25.0F, 8.0F), air_from(60.0F),
                                             air_from(61.0F)};
    for (const auto& stretches : {wall, ramp, gap}) {
        for (const float reaction_s : {0.01F, 0.05F, 0.1F}) {
            CHECK_COMPARE(drive_along(stretches, reaction_s).highest_excess, <=, 1.01F);
        }
    }
}

TEST(FeedAhead, a_machine_that_answers_20_percent_later_or_30_sooner_than_told_is_no_faster_either) {
    const std::vector<Stretch<float>> gap = {cut_from(0.0F), air_from(20.0F), cut_from(25.0F, 8.0F), air_from(60.0F),
                                             air_from(61.0F)};
    for (const auto& stretches : {wall, gap}) {
        CHECK_COMPARE(drive_along(stretches, 0.06F, 0.05F).highest_excess, <=, 1.01F);
        CHECK_COMPARE(drive_along(stretches, 0.035F, 0.05F).highest_excess, <=, 1.01F);
    }
    CHECK_COMPARE(drive_along(wall, 0.1F, 0.05F).highest_excess, >, 1.2F);
}

TEST(FeedAhead, a_gap_is_used_as_far_as_the_acceleration_lets_it) {
    const std::vector<Stretch<float>> gap = {cut_from(0.0F), air_from(20.0F), cut_from(60.0F), air_from(80.0F)};
    const std::vector<Stretch<float>> no_gap = {cut_from(0.0F), air_from(80.0F)};
    // 40 mm: from 10 to 60 mm/s and back takes 0.1 s and 3.5 mm each way; the rest goes at 60, but for the reaction.
    const float saved_s = drive_along(no_gap, 0.01F).time_s - drive_along(gap, 0.01F).time_s;
    DOUBLES_EQUAL(4.0 - 0.2 - 33.0 / 60.0, static_cast<double>(saved_s), 0.05);
}

TEST(FeedAhead, brakes_earlier_where_the_machine_answers_later_or_the_place_is_less_certain) {
    const auto feed_with = [](float reaction_s, float farthest_off_mm) {
        FeedAheadSettings<float> settings = exact(reaction_s);
        settings.farthest_off_mm = farthest_off_mm;
        Ahead ahead = with(wall, settings);
        Ahead::Step now = at(wall_mm - 2.5F);
        now.dt_s = 1.0F;
        now.feed_mm_s = 20.0F;
        now.asked_feed_mm_s = 20.0F;
        return ahead.step(now).feed_mm_s;
    };
    CHECK_COMPARE(feed_with(0.1F, 0.0F), <, feed_with(0.02F, 0.0F));
    CHECK_COMPARE(feed_with(0.02F, 1.0F), <, feed_with(0.02F, 0.0F));
}

TEST(FeedAhead, where_the_force_comes_late_a_stretch_counts_from_as_far_off_as_it_is_not_seen) {
    const auto feed_before_the_wall = [](float window_mm, float before_mm) {
        FeedAheadSettings<float> settings = exact();
        settings.farthest_off_mm = 1.5F;
        Ahead ahead = with(wall, settings);
        Ahead::Step in_air = estimate_at(wall_mm - 20.0F, 0.0F, air_feed_mm_s);
        in_air.window_mm = window_mm;
        (void)ahead.step(in_air);
        return ahead.step(at(wall_mm - before_mm)).feed_mm_s;
    };
    DOUBLES_EQUAL(wall_feed_mm_s, feed_before_the_wall(6.0F, 6.4F), 1e-3);
    CHECK_COMPARE(feed_before_the_wall(6.0F, 6.6F), >, wall_feed_mm_s);
    DOUBLES_EQUAL(wall_feed_mm_s, feed_before_the_wall(0.5F, 1.4F), 1e-3);
    CHECK_COMPARE(feed_before_the_wall(0.5F, 1.6F), >, wall_feed_mm_s);
}

TEST(FeedAhead, an_exit_counts_as_left_where_no_map_can_be_wrong_about_it) {
    FeedAheadSettings<float> settings = exact();
    settings.farthest_off_mm = 1.0F;
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)}, settings);
    DOUBLES_EQUAL(10.0, static_cast<double>(ahead.step(at(20.9F)).feed_mm_s), 1e-3);
    CHECK_COMPARE(ahead.step(at(21.1F)).feed_mm_s, >, 11.0F);
}

TEST(FeedAhead, a_place_is_passed_once_the_tool_will_be_behind_it_when_the_answer_acts) {
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)}, exact(0.1F));
    Ahead::Step now = at(19.0F);
    now.dt_s = 1.0F;
    now.feed_mm_s = 10.0F;
    now.asked_feed_mm_s = 10.0F;  // a millimetre in the reaction time, 0.7 surely
    DOUBLES_EQUAL(10.0, static_cast<double>(ahead.step(now).feed_mm_s), 1e-3);
    now.position_mm = 19.4F;
    CHECK_COMPARE(ahead.step(now).feed_mm_s, >, 30.0F);
}

TEST(FeedAhead, a_tool_that_is_held_passes_no_place_however_fast_it_is_asked_to_go) {
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)}, exact(0.1F));
    Ahead::Step now = at(19.9F);
    now.dt_s = 0.01F;
    now.asked_feed_mm_s = 40.0F;
    for (int k = 0; k < 200; ++k) {
        DOUBLES_EQUAL(10.0, static_cast<double>(ahead.step(now).feed_mm_s), 1e-3);
    }
}

TEST(FeedAhead, a_tool_held_slower_than_asked_is_not_thought_to_go_on_for_ever) {
    Ahead ahead = with(wall, exact(0.1F));
    Ahead::Step now = at(30.0F);
    now.dt_s = 0.001F;
    now.feed_mm_s = 10.0F;
    now.asked_feed_mm_s = 40.0F;
    for (int k = 0; k < 2000; ++k) {
        (void)ahead.step(now);
    }
    // Steady where what is asked for adds as much as leaks: T (u + p)/2 + T (p - u), 1.4 times the reaction time.
    const double pending_mm = 0.14 * 25.0 + 0.14 * 30.0;
    DOUBLES_EQUAL(std::sqrt(100.0 + 1000.0 * (10.0 - pending_mm)), static_cast<double>(ahead.step(now).feed_mm_s), 0.5);
}

TEST(FeedAhead, where_the_window_ends_the_feed_is_down_to_the_blind_one) {
    Ahead ahead = with(wall);
    Ahead::Step now = at(end_mm - 0.001F);
    DOUBLES_EQUAL(5.0, static_cast<double>(ahead.step(now).feed_mm_s), 0.1);
    now.position_mm = end_mm;
    CHECK_FALSE(ahead.step(now).known);
}

// ---- How far the map is believed
// -------------------------------------------------------------------------------------

TEST(FeedAhead, is_believed_once_the_forces_have_agreed_over_a_millimetre) {
    Ahead ahead = with(wall);
    CHECK_FALSE(cut(ahead, 41.0F, 41.8F, 300.0F).known);
    const WayAhead<float> way = cut(ahead, 41.9F, 42.2F, 300.0F);
    CHECK_TRUE(way.known);
    DOUBLES_EQUAL(2.0, static_cast<double>(way.tooth_per_tangential), 1e-6);
}

TEST(FeedAhead, a_harder_material_is_measured_and_slows_all_that_lies_ahead) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    const float feed_mm_s = cut(ahead, 1.0F, 10.0F, 390.0F).feed_mm_s;
    DOUBLES_EQUAL(1.3, static_cast<double>(ahead.hardness()), 1e-3);
    // At this feed the force is the mapped one again: F ∝ κ f.
    DOUBLES_EQUAL(10.0, 1.3 * static_cast<double>(feed_mm_s), 1e-2);
}

TEST(FeedAhead, before_the_first_cut_the_material_is_taken_for_harder_than_it_may_be) {
    FeedAheadSettings<float> usual;
    usual.acceleration_mm_s2 = 500.0F;
    FeedAheadSettings<float> as_in_the_file = usual;
    as_in_the_file.assumed_hardness = 1.0F;
    DOUBLES_EQUAL(static_cast<double>(with(wall, as_in_the_file).step(at(50.0F)).feed_mm_s),
                  1.3 * static_cast<double>(with(wall, usual).step(at(50.0F)).feed_mm_s), 1e-3);
}

TEST(FeedAhead, edge_forces_do_not_grow_with_the_feed) {
    Stretch<float> with_edge_forces = cut_from(0.0F);
    with_edge_forces.falling_share = 0.6F;
    with_edge_forces.feed_per_softness = 1.0F / 0.6F;
    Ahead ahead = with({with_edge_forces, air_from(60.0F)});
    // At half the feed 0.7 of the force is left: 252 N are 1.2 times as much.
    WayAhead<float> way;
    for (float s_mm = 1.0F; s_mm < 20.0F; s_mm += step_mm) {
        way = ahead.step(estimate_at(s_mm, 252.0F, 5.0F));
    }
    DOUBLES_EQUAL(1.2, static_cast<double>(ahead.hardness()), 1e-3);
    DOUBLES_EQUAL(252.0, static_cast<double>(way.tangential_N), 0.5);
    DOUBLES_EQUAL(1.0, 1.2 * (0.4 + 0.6 * static_cast<double>(way.feed_mm_s) / 10.0), 1e-3);
}

TEST(FeedAhead, the_force_that_is_expected_is_the_mean_over_the_window_and_the_tooth_the_highest_in_it) {
    FeedAheadSettings<float> settings = exact();
    settings.position_tolerance_mm = 1.0F;
    Stretch<float> thicker = cut_from(20.0F, wall_feed_mm_s, 340.0F);
    thicker.tooth_per_tangential = 2.5F;
    Ahead ahead = with({cut_from(0.0F), thicker, air_from(60.0F)}, settings);
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    // Of the window's half millimetre, 0.3 mm are in the thicker part.
    const WayAhead<float> way = ahead.step(estimate_at(20.3F, 324.0F));
    DOUBLES_EQUAL(0.4 * 300.0 + 0.6 * 340.0, static_cast<double>(way.tangential_N), 0.5);
    DOUBLES_EQUAL(2.5, static_cast<double>(way.tooth_per_tangential), 1e-6);
}

TEST(FeedAhead, in_air_no_force_is_expected) {
    Ahead ahead = with(wall);
    const WayAhead<float> way = ahead.step(estimate_at(10.0F, 3.0F));
    CHECK_EQUAL(0.0F, way.tangential_N);
    CHECK_EQUAL(0.0F, way.tooth_per_tangential);
}

TEST(FeedAhead, refuted_within_a_millimetre_where_the_force_is_another_than_the_map_can_mean) {
    for (const float tangential_N : {0.0F, 150.0F, 450.0F, 1000.0F}) {
        Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
        CHECK_TRUE(cut(ahead, 1.0F, 10.0F, 300.0F).known);
        CHECK_FALSE(cut(ahead, 10.1F, 10.9F, tangential_N).known);
        CHECK_TRUE(ahead.is_refuted());
        CHECK_FALSE(cut(ahead, 11.0F, 30.0F, 300.0F).known);
    }
}

TEST(FeedAhead, refuted_where_the_direction_of_the_force_is_that_of_another_arc) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    for (float s_mm = 1.0F; s_mm < 2.0F; s_mm += step_mm) {
        Ahead::Step now = estimate_at(s_mm, 300.0F);
        now.feed_force_N = -0.1F * 300.0F;
        CHECK_FALSE(ahead.step(now).known);
    }
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAhead, without_axis_currents_the_direction_is_not_asked_for) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    WayAhead<float> way;
    for (float s_mm = 1.0F; s_mm < 5.0F; s_mm += step_mm) {
        Ahead::Step now = estimate_at(s_mm, 300.0F);
        now.feed_force_valid = false;
        now.feed_force_N = std::numeric_limits<float>::quiet_NaN();
        way = ahead.step(now);
    }
    CHECK_TRUE(way.known);
}

TEST(FeedAhead, contact_in_mapped_air_refutes_at_the_second_estimate) {
    Ahead ahead = with(wall);
    (void)ahead.step(estimate_at(10.0F, 100.0F));
    CHECK_FALSE(ahead.is_refuted());
    (void)ahead.step(estimate_at(10.1F, 100.0F));
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAhead, contact_within_the_tolerance_of_a_wall_is_the_walls) {
    FeedAheadSettings<float> settings = exact();
    settings.position_tolerance_mm = 1.0F;
    Ahead ahead = with(wall, settings);
    CHECK_TRUE(cut(ahead, wall_mm - 0.8F, wall_mm + 4.0F, 300.0F).known);
}

TEST(FeedAhead, a_program_that_begins_again_starts_with_what_is_known_of_the_material) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 390.0F);
    (void)cut(ahead, 10.1F, 11.0F, 0.0F);
    CHECK_TRUE(ahead.is_refuted());
    ahead.restart();
    CHECK_TRUE(ahead.add(cut_from(0.0F)));
    CHECK_TRUE(ahead.add(air_from(60.0F)));
    CHECK_FALSE(ahead.is_refuted());
    DOUBLES_EQUAL(1.3, static_cast<double>(ahead.hardness()), 1e-3);
    CHECK_FALSE(ahead.step(estimate_at(1.0F, 390.0F)).known);
    CHECK_TRUE(cut(ahead, 1.0F, 4.0F, 390.0F).known);
}

// ---- What comes in from outside
// --------------------------------------------------------------------------------------

TEST(FeedAhead, takes_only_sound_stretches_in_order_and_as_many_as_it_holds) {
    Ahead ahead(exact());
    CHECK_TRUE(ahead.add(cut_from(1.0F)));
    CHECK_FALSE(ahead.add(cut_from(1.0F)));
    CHECK_FALSE(ahead.add(cut_from(0.5F)));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Stretch<float>& broken :
         {cut_from(nan), cut_from(2.0F, nan), cut_from(2.0F, 0.0F), cut_from(2.0F, -1.0F), cut_from(2.0F, 10.0F, nan),
          cut_from(2.0F, 10.0F, -1.0F)}) {
        CHECK_FALSE(ahead.add(broken));
    }
    for (float Stretch<float>::*const member :
         {&Stretch<float>::tooth_per_tangential, &Stretch<float>::feed_per_tangential, &Stretch<float>::falling_share,
          &Stretch<float>::feed_per_softness}) {
        Stretch<float> broken = cut_from(2.0F);
        broken.*member = nan;
        CHECK_FALSE(ahead.add(broken));
    }
    float begin_mm = 1.0F;
    while (ahead.room() > 0) {
        CHECK_TRUE(ahead.add(cut_from(++begin_mm)));
    }
    CHECK_FALSE(ahead.add(cut_from(begin_mm + 1.0F)));
    CHECK_COMPARE(begin_mm, ==, 256.0F);
}

TEST(FeedAhead, what_is_passed_makes_room) {
    Ahead ahead(exact());
    for (float s_mm = 0.0F; ahead.room() > 0; s_mm += 1.0F) {
        CHECK_TRUE(ahead.add(cut_from(s_mm)));
    }
    (void)ahead.step(estimate_at(100.5F, 300.0F));
    CHECK_COMPARE(ahead.room(), ==, 99U);  // all that end before 100.0 mm, where the estimate's window begins
}

TEST(FeedAhead, knows_nothing_where_the_position_is_not_told_not_a_number_or_off_the_map) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Ahead ahead = with({cut_from(1.0F), air_from(60.0F)});
    CHECK_TRUE(cut(ahead, 2.0F, 10.0F, 300.0F).known);
    for (const float position_mm : {nan, std::numeric_limits<float>::infinity(), 0.5F, 60.0F, 1000.0F}) {
        CHECK_FALSE(ahead.step(at(position_mm)).known);
    }
    Ahead::Step lost = at(10.0F);
    lost.position_known = false;
    CHECK_FALSE(ahead.step(lost).known);
    CHECK_TRUE(ahead.step(at(10.0F)).known);
}

TEST(FeedAhead, an_estimate_that_is_not_a_number_neither_agrees_nor_teaches) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    CHECK_TRUE(cut(ahead, 1.0F, 10.0F, 300.0F).known);
    const WayAhead<float> way = cut(ahead, 10.1F, 11.0F, nan);
    CHECK_FALSE(way.known);
    CHECK_TRUE(std::isfinite(way.feed_mm_s));
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 1e-3);
}

// ---- What the map does not know
// -------------------------------------------------------------------------------------

namespace {

Stretch<float> unknown_from(float begin_mm) {
    Stretch<float> stretch = air_from(begin_mm);
    stretch.is_known = false;
    return stretch;
}

Stretch<float> at_most_from(float begin_mm) {
    Stretch<float> stretch = cut_from(begin_mm);
    stretch.least_share = 0.0F;
    return stretch;
}

}  // namespace

TEST(FeedAhead, meets_what_it_does_not_know_at_the_blind_feed_and_says_that_it_does_not_know_it) {
    Ahead ahead = with({cut_from(0.0F), unknown_from(wall_mm), cut_from(wall_mm + 20.0F), air_from(end_mm)});
    const WayAhead<float> before = cut(ahead, 1.0F, 20.0F, 300.0F);
    CHECK_TRUE(before.known);
    DOUBLES_EQUAL(wall_feed_mm_s, before.feed_mm_s, 0.1);
    const WayAhead<float> within = ahead.step(at(wall_mm + 1.0F));
    CHECK_FALSE(within.known);
    DOUBLES_EQUAL(at(0.0F).blind_feed_mm_s, within.feed_mm_s, 1e-3);
    const WayAhead<float> behind = cut(ahead, wall_mm + 19.0F, wall_mm + 25.0F, 300.0F);
    CHECK_TRUE(behind.known);
}

TEST(FeedAhead, what_is_known_at_most_is_met_no_slower_than_what_is_not_known_at_all) {
    constexpr float slow_mm_s = 2.0F;
    Stretch<float> heavy = at_most_from(20.0F);
    heavy.feed_mm_s = slow_mm_s;
    Ahead ahead = with({cut_from(0.0F), heavy, cut_from(40.0F, slow_mm_s), air_from(end_mm)});
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    DOUBLES_EQUAL(at(0.0F).blind_feed_mm_s, ahead.step(at(25.0F)).feed_mm_s, 1e-3);
    DOUBLES_EQUAL(slow_mm_s, ahead.step(at(45.0F)).feed_mm_s, 1e-3);
}

TEST(FeedAhead, until_the_material_is_known_no_cut_is_met_slower_than_what_is_not_known_at_all) {
    constexpr float slow_mm_s = 2.0F;
    Ahead ahead = with({cut_from(0.0F, slow_mm_s, 60.0F), air_from(end_mm)});
    DOUBLES_EQUAL(at(0.0F).blind_feed_mm_s, ahead.step(at(1.0F)).feed_mm_s, 1e-3);
    const WayAhead<float> way = cut(ahead, 1.1F, 10.0F, 300.0F);  // five times the feed, five times the force
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 1e-3);
    DOUBLES_EQUAL(slow_mm_s, way.feed_mm_s, 1e-3);
}

TEST(FeedAhead, a_force_where_it_knows_nothing_neither_confirms_nor_refutes_it) {
    Ahead ahead = with({air_from(0.0F), unknown_from(10.0F), air_from(end_mm)});
    CHECK_FALSE(cut(ahead, 12.0F, 30.0F, 900.0F).known);
    CHECK_FALSE(ahead.is_refuted());
    cut(ahead, 30.0F, 60.0F, 0.0F);
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAhead, what_has_agreed_stays_where_only_the_window_is_lost) {
    const std::vector<Stretch<float>> map{cut_from(0.0F), air_from(end_mm)};
    Ahead ahead = with(map);
    CHECK_TRUE(cut(ahead, 1.0F, 3.0F, 300.0F).known);
    ahead.empty();
    CHECK_FALSE(ahead.step(at(3.1F)).known);
    for (const Stretch<float>& stretch : map) {
        CHECK_TRUE(ahead.add(stretch));
    }
    CHECK_TRUE(ahead.step(at(3.2F)).known);
    ahead.restart();
    for (const Stretch<float>& stretch : map) {
        CHECK_TRUE(ahead.add(stretch));
    }
    CHECK_FALSE(ahead.step(at(3.3F)).known);
}

TEST(FeedAhead, a_cut_that_is_known_at_most_says_as_much_as_is_sure_of_it) {
    Stretch<float> half = cut_from(0.0F);
    half.least_share = 0.5F;
    const std::vector<Stretch<float>> map{half, air_from(end_mm)};
    Ahead ahead = with(map);
    CHECK_FALSE(cut(ahead, 1.0F, 2.8F, 250.0F).known);
    CHECK_TRUE(cut(ahead, 2.9F, 3.2F, 250.0F).known);
    DOUBLES_EQUAL(0.0, static_cast<double>(ahead.hardness()), 1e-6);  // the share could be the material
    Ahead too_little = with(map);
    cut(too_little, 1.0F, 3.0F, 60.0F);  // less than half of the softest
    CHECK_TRUE(too_little.is_refuted());
}

TEST(FeedAhead, where_the_tool_enters_any_force_up_to_that_of_the_cut_agrees_and_no_more) {
    for (const float force_N : {0.0F, 40.0F, 290.0F}) {
        Ahead ahead = with({at_most_from(0.0F), air_from(end_mm)});
        CHECK_FALSE(cut(ahead, 1.0F, 20.0F, force_N).known);  // it does not confirm the map either
        CHECK_FALSE(ahead.is_refuted());
    }
    Ahead ahead = with({at_most_from(0.0F), air_from(end_mm)});
    cut(ahead, 1.0F, 20.0F, 900.0F);
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAhead, where_the_tool_enters_it_says_nothing_of_a_tooths_share) {
    Ahead ahead = with({cut_from(0.0F), at_most_from(20.0F), air_from(end_mm)});
    CHECK_COMPARE(cut(ahead, 1.0F, 15.0F, 300.0F).tooth_per_tangential, >, 0.0F);
    DOUBLES_EQUAL(0.0, static_cast<double>(cut(ahead, 22.0F, 25.0F, 200.0F).tooth_per_tangential), 1e-6);
}
