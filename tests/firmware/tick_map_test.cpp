// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_milling.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using control::CutState;
using control::Fault;

namespace {

const float lowest = machine_and_tool().machine.cnc.override_min;

/// In the cut for 1.1 s with this map.
Tick in_cut(const control::WayAhead<float>& way, const Tick& begun = fresh_tick(), Load load = whole) {
    Milling milling(begun);
    milling.mill(air, 200).mill(load, 200);
    milling.tick().set_way_ahead(way);
    milling.mill(load, 1100);
    CHECK(milling.state() == CutState::in_cut || milling.state() == CutState::fault);
    return milling.tick();
}

float ratio_in_cut(const control::WayAhead<float>& way, const Tick& begun = fresh_tick()) {
    return in_cut(way, begun).control().ratio;
}

control::WayAhead<float> way_with(float tooth_per_tangential) {
    control::WayAhead<float> way;
    way.known = true;
    way.feed_mm_s = 100.0F;
    way.tooth_per_tangential = tooth_per_tangential;
    return way;
}

}  // namespace

TEST_GROUP(TickWithMap){};

TEST(TickWithMap, takes_the_tooths_share_of_the_force_from_the_map) {
    const float light = ratio_in_cut(way_with(2.6F));
    const float heavy = ratio_in_cut(way_with(5.0F));
    CHECK(heavy < 0.75F * light);
}

TEST(TickWithMap, of_which_nothing_is_known_is_without_one) {
    control::WayAhead<float> unknown = way_with(5.0F);
    unknown.known = false;
    CHECK(ratio_in_cut(unknown) == ratio_in_cut({}));
}

TEST(TickWithMap, that_sees_air_leaves_the_force_as_it_is_measured) {
    const float by_forces = ratio_in_cut(way_with(0.0F));
    CHECK(by_forces > 1.1F * ratio_in_cut(way_with(5.0F)));
    CHECK(by_forces < ratio_in_cut(way_with(0.1F)));  // the least that the forces leave
}

TEST(TickWithMap, takes_the_maps_force_within_the_noise_of_the_measured_one) {
    control::WayAhead<float> way = way_with(5.0F);
    const float as_measured = ratio_in_cut(way);
    way.tangential_N = 1.0F;
    CHECK(ratio_in_cut(way) > as_measured);
    way.tangential_N = 10'000.0F;
    const float heavier = ratio_in_cut(way);
    CHECK(heavier < as_measured);
    CHECK(heavier > 0.6F * as_measured);  // 319 N in place of 296 N
}

TEST(TickWithMap, believes_no_smaller_tooth_than_the_forces_leave) {
    Parameters p = machine_and_tool();
    p.tool.tooth_force_limit_N = 150.0F;
    const Tick weak_tool(p);
    const float of_least = in_cut(way_with(0.1F), weak_tool).control().ratio;
    DOUBLES_EQUAL(static_cast<double>(of_least), static_cast<double>(in_cut(way_with(0.5F), weak_tool).control().ratio),
                  1e-3);
    CHECK(of_least < 0.9F * p.machine.cnc.override_max);
}

TEST(TickWithMap, believes_a_smaller_tooth_than_a_bound) {
    CHECK(in_cut({}).estimate().tooth_force_is_bound);
    CHECK(ratio_in_cut(way_with(0.8F)) > 1.8F * ratio_in_cut({}));
}

TEST(TickWithMap, is_in_no_overload_by_a_force_that_the_map_alone_knows) {
    const Tick tick = in_cut(way_with(8.0F));
    CHECK(tick.control().fault == Fault::none);
    CHECK(tick.control().ratio == lowest);
}

TEST(TickWithMap, counts_half_where_the_forces_determine_the_tooths_share_by_themselves) {
    Parameters p = well_known_machine();
    const Tick tick(p);
    p.tool.tooth_force_limit_N /= 1.4F;
    const Tick weaker(p);
    const Tick by_forces = in_cut({}, tick, wide);
    CHECK_FALSE(by_forces.estimate().tooth_force_is_bound);
    const float share = by_forces.estimate().tooth_force_N.value / by_forces.estimate().newest_tangential_N;
    const float of_weaker = in_cut(way_with(share), weaker, wide).control().ratio;
    const float by_both = in_cut(way_with(1.8F * share), tick, wide).control().ratio;
    CHECK(of_weaker < 0.9F * p.machine.cnc.override_max);
    DOUBLES_EQUAL(static_cast<double>(of_weaker), static_cast<double>(by_both), 0.01);
}

TEST(TickWithMap, is_believed_alone_where_the_forces_leave_no_engagement) {
    const Tick by_map = in_cut(way_with(4.0F), Tick(with_unclear_torque()));
    const Tick by_spindle_and_map = in_cut(way_with(4.0F), Tick(without_axes(with_unclear_torque())));
    CHECK_FALSE(by_map.estimate().tooth_force_N.valid);
    CHECK(by_spindle_and_map.estimate().tooth_force_is_bound);
    DOUBLES_EQUAL(static_cast<double>(by_spindle_and_map.control().ratio), static_cast<double>(by_map.control().ratio),
                  0.01);
}

TEST(TickWithMap, is_in_no_overload_by_it_where_the_forces_leave_no_engagement) {
    const Tick tick = in_cut(way_with(8.0F), Tick(with_unclear_torque()));
    CHECK(tick.control().fault == Fault::none);
    CHECK(tick.control().ratio == lowest);
}

TEST(TickWithMap, is_in_no_overload_by_a_bound_that_it_lowers) {
    Parameters p = machine_and_tool();
    p.tool.tooth_force_limit_N = 100.0F;
    const Tick tick = in_cut(way_with(0.1F), Tick(p));
    CHECK(tick.estimate().tooth_force_is_bound);
    CHECK(tick.estimate().least_tooth_force_N > 1.35F * 100.0F);
    CHECK(tick.control().fault == Fault::none);
}
