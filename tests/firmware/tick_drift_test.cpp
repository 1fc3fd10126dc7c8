// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_milling.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using control::CutState;

namespace {

constexpr Load axis_faded{1.0F, -0.2F};

/// Knows the width of a cut.
Parameters sure_machine() {
    Parameters p = well_known_machine();
    p.tool.control.depth_step_ratio = 1.0F;
    p.tool.control.surge_radial_immersion = 0.0F;
    p.tool.tooth_force_limit_N = 500.0F;
    return p;
}

const Tick& tick_of_sure_machine() {
    static const Tick tick(sure_machine());
    return tick;
}

/// The axes stand, so the cut does not fade while it ends. Nothing is learnt in the air that follows.
void leave_at_once(Milling& milling, Load load) {
    control::WayAhead<float> may_cut;
    may_cut.may_cut = true;
    milling.tick().set_way_ahead(may_cut);
    milling.dwell(load, 60).dwell(air, 100).mill(air, 150);
    CHECK(milling.state() == CutState::air);
}

}  // namespace

TEST_GROUP(TickInDrift){};

TEST(TickInDrift, speeds_up_in_a_cut_that_becomes_lighter_by_both_forces) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(milling.mill_from(whole, lighter, 2500).mill(lighter).ratio() > 1.18F * before);
}

TEST(TickInDrift, hardly_speeds_up_where_the_spindle_alone_carries_less) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(milling.mill_from(whole, faded, 2500).mill(faded).ratio() < 1.15F * before);
    CHECK(milling.tick().control().state == CutState::in_cut);
}

TEST(TickInDrift, takes_the_next_cut_by_itself) {
    Milling fresh;
    Milling milling;
    milling.mill(air, 200).enter_the_cut(whole).leave_the_cut(whole);
    DOUBLES_EQUAL(static_cast<double>(fresh.mill(air, 200).enter_the_cut(faded).ratio()),
                  static_cast<double>(milling.enter_the_cut(faded).ratio()), 0.04);
}

TEST(TickInDrift, does_not_believe_it_there_if_it_has_faded_in_the_cut_before) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    milling.mill_from(whole, faded, 2500).leave_the_cut(faded);
    CHECK(milling.enter_the_cut(faded, 6000).ratio() < 1.15F * before);
}

TEST(TickInDrift, believes_it_again_once_the_spindle_is_found_sound_in_air) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    milling.mill_from(whole, faded, 2500).leave_the_cut(faded).rest();
    CHECK(milling.enter_the_cut(faded, 6000).ratio() > 1.25F * before);
}

TEST(TickInDrift, believes_a_slow_fall_on_a_machine_with_axes_and_none_on_the_spindle_alone) {
    Milling with_axes;
    Milling alone(tick_alone());
    const float before = with_axes.mill(air, 200).enter_the_cut(whole).ratio();
    const float before_alone = alone.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(with_axes.mill_from(whole, lighter, 2500).ratio() > 1.1F * before);
    CHECK(alone.mill_from(whole, lighter, 2500).ratio() < 1.02F * before_alone);
}

TEST(TickInDrift, believes_the_spindle_alone_again_once_it_is_found_sound_in_air) {
    Milling alone(tick_alone());
    const float before = alone.mill(air, 200).enter_the_cut(whole).ratio();
    alone.mill_from(whole, lighter, 2500).leave_the_cut(lighter).rest();
    CHECK(alone.enter_the_cut(lighter, 6000).ratio() > 1.25F * before);
}

TEST(TickInDrift, takes_what_is_lost_at_the_end_of_a_cut_for_no_fall_of_the_spindle_alone) {
    Milling alone(tick_alone());
    const float before = alone.mill(air, 200).enter_the_cut(whole).ratio();
    alone.leave_the_cut(whole);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(alone.enter_the_cut(whole).ratio()), 0.05);
}

TEST(TickInDrift, shows_no_engagement_that_the_forces_do_not_determine) {
    Milling milling;
    milling.mill(air, 200).mill({1.0F, -0.67F});  // pushed along the feed: wide, or up milled
    CHECK(milling.tick().control().state == CutState::in_cut);
    CHECK(milling.tick().estimate().engagement.solved);
    CHECK_FALSE(milling.tick().estimate().engagement.immersion_valid);
    CHECK_FALSE(milling.tick().engagement().immersion_valid);
    CHECK_FALSE(milling.tick().engagement().depth_valid);
}

TEST(TickInDrift, does_not_speed_up_by_a_depth_that_is_not_the_declared_one) {
    Parameters p = with_all_currents();
    p.tool.declared_axial_depth_mm = 1.0F;  // of some 8
    Milling milling{Tick(p)};
    milling.mill(air, 200).enter_the_cut(whole);
    CHECK(milling.tick().control().limit == control::Limit::law_misfit);
}

TEST(TickInDrift, believes_a_slow_fall_where_the_one_axis_that_is_known_carries_less_too) {
    for (const std::size_t known : {std::size_t{0}, std::size_t{1}}) {
        Parameters p = spindle_alone();
        p.machine.axes[known] = machine_and_tool().machine.axes[known];
        Milling milling{Tick(p)};
        milling.is_along_y = known == 1;
        const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
        CHECK(milling.mill_from(whole, lighter, 2500).ratio() > 1.1F * before);
    }
}

TEST(TickInDrift, believes_a_slow_fall_of_the_spindle_alone_where_a_map_knows_the_cut) {
    Milling alone(tick_alone());
    control::WayAhead<float> way;
    way.known = true;
    way.feed_mm_s = 100.0F;
    alone.tick().set_way_ahead(way);
    const float before = alone.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(alone.mill_from(whole, lighter, 2500).ratio() > 1.1F * before);
}

TEST(TickInDrift, hardly_speeds_up_where_the_axis_alone_carries_less) {
    Milling milling(tick_of_sure_machine());
    const float before = milling.rest().enter_the_cut(wide).ratio();
    CHECK(milling.mill_from(wide, axis_faded, 2500).mill(axis_faded).ratio() < 1.1F * before);
    Milling fresh(tick_of_sure_machine());
    CHECK(fresh.rest().enter_the_cut(axis_faded).ratio() > 1.4F * before);
}

TEST(TickInDrift, believes_the_axis_in_the_next_cut) {
    Milling milling(tick_of_sure_machine());
    const float before = milling.rest().enter_the_cut(wide).ratio();
    leave_at_once(milling, wide);
    CHECK(milling.enter_the_cut(axis_faded, 3000).ratio() > 1.4F * before);
}

TEST(TickInDrift, believes_a_faded_axis_again_once_it_is_found_sound_in_air) {
    Milling milling(tick_of_sure_machine());
    const float before = milling.rest().enter_the_cut(wide).ratio();
    leave_at_once(milling.mill_from(wide, axis_faded, 2500), axis_faded);
    Milling after_air = milling;
    CHECK(milling.enter_the_cut(axis_faded, 3000).ratio() < 1.1F * before);
    after_air.tick().set_way_ahead({});
    CHECK(after_air.mill(air, 150).enter_the_cut(axis_faded, 3000).ratio() > 1.4F * before);
}

TEST(TickInDrift, takes_no_held_feed_for_the_end_of_a_cut) {
    Milling milling(tick_of_sure_machine());
    const float before = milling.rest().enter_the_cut(wide).ratio();
    milling.status.feed_hold = true;
    milling.dwell(wide, 100);
    milling.status.feed_hold = false;
    CHECK(milling.mill_from(wide, axis_faded, 200).mill(axis_faded, 3000).ratio() < 1.1F * before);
}

TEST(TickInDrift, is_in_no_overload_by_a_force_that_doubt_alone_makes_possible) {
    Parameters p = sure_machine();
    p.tool.tooth_force_limit_N = 400.0F;
    Milling milling{Tick(p)};
    const float before = milling.rest().enter_the_cut(wide).ratio();
    milling.mill_from(wide, {1.22F, -0.25F}, 2500);
    CHECK(milling.tick().control().fault == control::Fault::none);
    CHECK(milling.ratio() < before);
}
