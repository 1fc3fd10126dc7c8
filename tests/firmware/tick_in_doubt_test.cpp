// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_milling.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using control::CutState;

namespace {

/// So little of the cut of tick_bench.hpp that it may be drift as well.
constexpr Load hardly_a_cut{0.03F, 1.0F};
constexpr double its_force_N = 250.0 * static_cast<double>(hardly_a_cut.spindle);

constexpr Load half_faded{0.5F, 1.0F};

constexpr Load narrow{0.7F, 0.63F};
constexpr Load heavier{3.0F, 3.0F};
constexpr Load of_no_cut{1.0F, 4.0F};

control::WayAhead<float> with_cut(bool may_cut) {
    control::WayAhead<float> way;
    way.may_cut = may_cut;
    return way;
}

}  // namespace

TEST_GROUP(TickInDoubt) {
    Milling milling{fresh_tick()};

    /// What is left of a light cut after a rest in air.
    double force_in_light_cut_N(const control::WayAhead<float>& way) {
        milling.rest(300);
        milling.tick().set_way_ahead(way);
        milling.mill(hardly_a_cut, 2000);
        return static_cast<double>(milling.tick().estimate().steady_tangential_N.value);
    }
};

TEST(TickInDoubt, learns_no_force_as_drift_where_the_map_may_have_a_cut) {
    DOUBLES_EQUAL(its_force_N, force_in_light_cut_N(with_cut(true)), 0.2 * its_force_N);
}

TEST(TickInDoubt, learns_a_small_force_where_the_map_has_air) {
    DOUBLES_EQUAL(0.0, force_in_light_cut_N(with_cut(false)), 0.2 * its_force_N);
}

TEST(TickInDoubt, shows_an_engagement_in_the_cut_alone_and_while_it_is_held) {
    milling.mill(air, 200);
    bool was_in_entry = false;
    for (int k = 0; k < 700; ++k) {
        milling.mill(whole, 1);
        was_in_entry = was_in_entry || milling.state() == CutState::entry;
        CHECK(milling.state() == CutState::in_cut || !milling.tick().engagement().immersion_valid);
        CHECK(milling.state() == CutState::in_cut || !milling.tick().engagement().depth_valid);
    }
    CHECK(was_in_entry);
    CHECK(milling.tick().engagement().immersion_valid);
    milling.status.feed_hold = true;
    milling.mill(whole, 100);
    CHECK(milling.state() == CutState::hold);
    CHECK(milling.tick().engagement().immersion_valid);
}

TEST(TickInDoubt, shows_no_engagement_in_a_cut_that_fades) {
    Milling sure{Tick(well_known_machine())};
    sure.mill(air, 200).mill(whole, 1000);
    CHECK(sure.tick().engagement().immersion_valid);
    sure.mill_from(whole, {0.8F, 0.8F}, 60);
    CHECK(sure.state() == CutState::in_cut);
    CHECK(sure.tick().control().fading);
    CHECK(sure.tick().estimate().engagement.immersion_valid);
    CHECK_FALSE(sure.tick().engagement().immersion_valid);
    CHECK_FALSE(sure.tick().engagement().depth_valid);
}

TEST(TickInDoubt, does_not_speed_up_by_forces_that_no_cut_has) {
    milling.mill(air, 200).mill(of_no_cut);
    CHECK(milling.tick().control().limit == control::Limit::law_misfit);
}

TEST(TickInDoubt, does_not_trust_forces_that_fit_a_cut_after_many_that_fitted_none) {
    milling.mill(air, 200).mill(of_no_cut).mill_from(of_no_cut, whole, 100).mill(whole, 300);
    CHECK(milling.state() == CutState::in_cut);
    CHECK_FALSE(milling.tick().engagement().immersion_valid);
    CHECK(milling.tick().control().limit == control::Limit::law_misfit);
    milling.mill(whole, 6500);  // four times as long
    CHECK(milling.tick().engagement().immersion_valid);
}

TEST(TickInDoubt, trusts_the_next_cut_again) {
    milling.mill(air, 200).mill(of_no_cut).mill_from(of_no_cut, air, 300).mill(air, 300).mill(whole, 800);
    CHECK(milling.state() == CutState::in_cut);
    CHECK(milling.tick().engagement().immersion_valid);
}

TEST(TickInDoubt, keeps_the_depth_of_the_cut_where_it_becomes_too_narrow_to_show_it) {
    Milling sure{Tick(well_known_machine())};
    sure.mill(air, 200).mill(wide, 800).mill_from(wide, narrow, 300).mill(narrow, 100);
    CHECK(sure.tick().engagement().depth_is_remembered);
}

TEST(TickInDoubt, keeps_no_depth_of_an_entry) {
    Milling sure{Tick(well_known_machine())};
    sure.mill(air, 200).mill(wide, 200).mill(narrow, 10);
    CHECK(sure.state() == CutState::entry);
    sure.mill(narrow, 200);
    CHECK(sure.state() == CutState::in_cut);
    CHECK_FALSE(sure.tick().engagement().depth_is_remembered);
}

TEST(TickInDoubt, slows_down_for_the_worst_tooth_where_the_forces_leave_no_engagement) {
    Parameters p = with_unclear_torque();
    p.tool.tooth_force_limit_N = 50.0F;
    Milling unclear{Tick(p)};
    unclear.mill(air, 200).mill(whole);
    CHECK_FALSE(unclear.tick().estimate().tooth_force_N.valid);
    CHECK(unclear.ratio() < 0.3F);
}

TEST(TickInDoubt, slows_down_before_a_force_that_grows_by_as_much_as_the_cnc_is_late) {
    Parameters p = with_all_currents();
    p.machine.cnc.override_latency_s = 0.01F;
    Milling prompt{Tick(p)};
    p.machine.cnc.override_latency_s = 0.1F;
    Milling late{Tick(p)};
    for (Milling* each : {&prompt, &late}) {
        each->rest().enter_the_cut(whole).mill_from(whole, heavier, 60);
    }
    CHECK(late.ratio() < 0.5F * prompt.ratio());
}

/// Forces along the feed that stay contradict it. The axes of this cut do not determine its width: the tooth force is a
/// bound, some twice F_at.
TEST(TickInDoubt, hardly_speeds_up_on_a_spindle_current_that_fades_while_the_axes_carry_what_they_did) {
    milling.mill(air, 200).mill(whole, 2800);
    const float before = milling.ratio();
    CHECK(before > 0.5F);
    milling.watch_highest_ratio().mill_from(whole, half_faded, 2500).mill(half_faded);
    CHECK(milling.highest_ratio() < 1.15F * before);
    CHECK(milling.tick().control().fault == control::Fault::none);
}
