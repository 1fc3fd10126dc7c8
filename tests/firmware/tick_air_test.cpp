// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_milling.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;
using control::CutState;

TEST_GROUP(TickInAir) {
    Milling milling;

    double force_N() {
        return static_cast<double>(milling.tick().estimate().steady_tangential_N.value);
    }
    float friction_scale() {
        return milling.tick().estimator().friction_scale(0, true);
    }
};

TEST(TickInAir, learns_no_force_below_zero_as_drift_while_the_axes_move) {
    constexpr Load below_idle{-0.06F, 0.0F};
    milling = Milling{Tick(well_known_machine())};
    milling.rest(300).mill(below_idle, 2000);
    CHECK(milling.state() == CutState::air);
    DOUBLES_EQUAL(-0.06 * 250.0, force_N(), 1.5);
}

/// The idle torque is 3.6 of its deviations above the calibrated one, and the cut as much as its own noise may hide.
TEST(TickInAir, takes_torque_beyond_the_doubt_of_the_idle_torque_for_a_cut_where_the_tool_may_be_in_one) {
    constexpr Load idle{0.144F, 0.0F};  // 0.18 N·m
    constexpr Load light_cut{0.224F, 0.0F};
    Parameters p = well_known_machine();
    p.machine.spindle.idle_torque_sd_Nm = 0.05F;
    p.tool.control.contact_force_N = 60.0F;
    milling = Milling{Tick(p)};
    milling.dwell(idle, 300);
    DOUBLES_EQUAL(0.0, force_N(), 1.5);
    milling.mill(light_cut, 2000);
    CHECK(milling.tick().control().fault == control::Fault::none);
    CHECK(milling.tick().estimate().tangential_N.valid);
    DOUBLES_EQUAL(20.0, force_N(), 5.0);
    milling.dwell(light_cut, 2000);
    CHECK(milling.tick().control().fault == control::Fault::idle_torque);
}

/// Of 28 N, where contact is 60 N, like an idle torque that has drifted.
TEST(TickInAir, finds_no_fault_where_a_cut_too_light_for_contact_was_learnt_as_idle_torque) {
    constexpr Load light_cut{28.0F / 250.0F, 28.0F / 250.0F};
    Parameters p = well_known_machine();
    p.tool.control.contact_force_N = 60.0F;
    milling = Milling{Tick(p)};
    milling.rest(300).mill(light_cut, 5000);
    CHECK(milling.state() == CutState::air);
    DOUBLES_EQUAL(28.0, static_cast<double>(milling.tick().estimate().uncertain_idle_N), 3.0);
    milling.mill(Load{-4.0F / 250.0F, 0.0F}, 60);
    CHECK_COMPARE(force_N(), <, -10.0);
    milling.mill(air, 1500);
    CHECK(milling.tick().control().fault == control::Fault::none);
    DOUBLES_EQUAL(0.0, force_N(), 2.0);
}

TEST(TickInAir, goes_on_learning_an_idle_torque_that_drifts_while_the_axes_feed) {
    Parameters p = well_known_machine();
    p.tool.control.contact_force_N = 60.0F;
    milling = Milling{Tick(p)};
    milling.rest(300);
    for (int k = 0; k < 20; ++k) {
        milling.mill({static_cast<float>(k) / 250.0F, 0.0F}, 1000);  // 1 N a second
    }
    CHECK(milling.state() == CutState::air);
    DOUBLES_EQUAL(0.0, force_N(), 3.0);
}

TEST(TickInAir, learns_no_friction_where_no_spindle_current_says_that_it_is_air) {
    constexpr Load axis_alone{0.0F, 1.0F};
    const Milling begun = milling.rest(300);
    const float before = friction_scale();
    milling.mill(axis_alone, 45);
    CHECK(friction_scale() != before);
    milling = begun;
    milling.missing = hal::mask(hal::Present::spindle_current);
    milling.mill(axis_alone, 45);
    CHECK(milling.state() == CutState::air);
    CHECK(friction_scale() == before);
}

TEST(TickInAir, learns_nothing_in_a_cut_whose_axes_stand) {
    milling.mill(air, 200).mill(whole, 800).dwell(whole, 500);
    CHECK(milling.state() == CutState::in_cut);
    DOUBLES_EQUAL(250.0, force_N(), 12.5);
}

TEST(TickInAir, learns_nothing_of_the_revolution_in_which_it_ended) {
    constexpr int samples_of_a_revolution = 15;
    Milling begun;
    begun.rest(300);
    for (int phase = 0; phase < samples_of_a_revolution; ++phase) {
        milling = begun.rest(1);
        milling.dwell(whole, 30).dwell(air, 60).mill(air, 150);
        CHECK(milling.state() == CutState::air);
        for (int k = 0; k < 100; ++k) {
            milling.rest(1);
            DOUBLES_EQUAL(0.0, static_cast<double>(milling.tick().estimate().tangential_N.value), 1.0);
        }
    }
}
