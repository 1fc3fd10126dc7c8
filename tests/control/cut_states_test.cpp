// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(CutStates){};

TEST(CutStates, starts_in_air_and_stays_there_without_contact) {
    Controller controller;
    CHECK(repeat(controller, in_air(), 1000).state == CutState::air);
}

TEST(CutStates, takes_a_force_within_its_noise_for_no_contact) {
    Controller controller;
    Input noisy = in_contact();
    noisy.cut.tangential_sd_N = 51.0F;  // 200 N is less than four of them
    CHECK(repeat(controller, noisy, 100).state == CutState::air);
    noisy.cut.tangential_sd_N = 49.0F;
    CHECK(repeat(controller, noisy, 2).state == CutState::entry);
}

TEST(CutStates, takes_a_force_that_is_not_valid_for_no_contact) {
    Controller controller;
    CHECK(repeat(controller, without_force(in_contact()), 10).state == CutState::air);
}

TEST(CutStates, takes_one_force_alone_for_no_contact) {
    Controller controller;
    for (int k = 0; k < 100; ++k) {
        CHECK(controller.step(in_contact()).state == CutState::air);
        CHECK(controller.step(in_air()).state == CutState::air);
    }
    CHECK(repeat(controller, in_contact(), 2).state == CutState::entry);
}

TEST(CutStates, is_in_cut_after_the_entry_revolutions_and_the_entry_travel_both) {
    Parameters p;
    p.entry_travel_mm = 0.0F;
    Controller by_revolutions(p);
    CHECK(repeat(by_revolutions, in_contact(), 9).state == CutState::entry);  // 7 tooth periods after contact
    CHECK(by_revolutions.step(in_contact()).state == CutState::in_cut);       // 8: two revolutions of four teeth
    p.entry_travel_mm = 5.0F;
    Controller by_travel(p);
    CHECK(repeat(by_travel, in_contact(), 249).state == CutState::entry);
    CHECK(repeat(by_travel, in_contact(), 4).state == CutState::in_cut);
}

TEST(CutStates, a_speed_that_is_not_a_number_for_a_step_keeps_the_tool_from_no_state) {
    for (const float speed_mm_s : {not_a_number, beyond_all}) {
        Controller controller;
        Input once = in_contact();
        repeat(controller, once, 2);
        once.path_speed_mm_s = speed_mm_s;
        CHECK(controller.step(once).state == CutState::entry);
        CHECK(repeat(controller, in_contact(), 240).state == CutState::entry);
        CHECK(repeat(controller, in_contact(), 20).state == CutState::in_cut);
    }
}

TEST(CutStates, counts_revolutions_only_by_new_tooth_periods) {
    Parameters p;
    p.entry_travel_mm = 0.0F;
    Controller controller(p);
    repeat(controller, in_contact(), 2);
    Input between = in_contact();
    between.cut.fresh = false;
    CHECK(repeat(controller, between, 1000).state == CutState::entry);
}

TEST(CutStates, leaves_entry_and_in_cut_to_exit_where_contact_is_lost) {
    Controller in_entry;
    repeat(in_entry, in_contact(), 2);
    CHECK(in_entry.step(in_air()).state == CutState::exit);
    Controller in_cut;
    bring_into_cut(in_cut);
    CHECK(in_cut.step(in_air()).state == CutState::exit);
}

TEST(CutStates, a_force_that_is_not_valid_ends_no_contact) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(repeat(controller, without_force(in_air()), 10).state == CutState::in_cut);
}

TEST(CutStates, keeps_the_state_between_half_and_the_whole_contact_force) {
    Parameters p;
    p.contact_force_N = 40.0F;
    Controller controller(p);
    bring_into_cut(controller);
    Input faint = in_contact();
    faint.cut.tangential_N = 21.0F;
    CHECK(repeat(controller, faint, 50).state == CutState::in_cut);
    faint.cut.tangential_N = 19.0F;
    CHECK(controller.step(faint).state == CutState::exit);
}

TEST(CutStates, is_in_air_again_after_the_exit_travel) {
    Controller controller;
    bring_into_cut(controller);
    controller.step(in_air());
    CHECK(repeat(controller, in_air(), 98).state == CutState::exit);  // 1.96 mm
    CHECK(repeat(controller, in_air(), 4).state == CutState::air);
}

TEST(CutStates, keeps_the_feed_over_the_gap_of_an_interrupted_cut) {
    Controller controller;
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 2000).ratio;
    CHECK(before > 1.0F);  // well above the entry ceiling of 0.64
    const Output gap = repeat(controller, in_air(), 20);
    CHECK(gap.state == CutState::exit);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(gap.ratio), 1e-6);
    const Output again = controller.step(in_contact());
    CHECK(again.state == CutState::entry);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(again.ratio), 1e-6);
}

TEST(CutStates, reaches_the_air_state_only_where_the_force_says_so) {
    Controller controller;
    bring_into_cut(controller);
    controller.step(in_air());
    CHECK(repeat(controller, without_force(in_contact()), 500).state != CutState::air);
}

TEST(CutStates, is_not_in_air_by_its_travel_alone) {
    Controller controller;
    bring_into_cut(controller);
    Input between = in_air();
    controller.step(between);
    between.cut.fresh = false;
    repeat(controller, between, 200);  // 4 mm, twice the exit travel
    CHECK(controller.step(without_force(in_air())).state == CutState::exit);
    CHECK(controller.step(in_air()).state == CutState::air);
}

TEST(CutStates, holds_while_the_feed_is_held_and_goes_on_with_the_next_estimate) {
    for (const bool cutting : {true, false}) {
        Controller controller;
        bring_into_cut(controller);
        Input held = cutting ? in_contact() : in_air();
        held.feed_hold = true;
        const float before = controller.step(in_contact()).ratio;
        const Output hold = repeat(controller, held, 300);
        CHECK(hold.state == CutState::hold);
        CHECK(hold.hold);
        CHECK(hold.ratio <= before);
        held.feed_hold = false;
        const Output released = controller.step(held);
        CHECK(released.state == (cutting ? CutState::in_cut : CutState::exit));
        CHECK_FALSE(released.hold);
    }
}

TEST(CutStates, behind_a_hold_in_the_cut_looks_for_contact_for_the_exit_travel) {
    Controller controller;
    bring_into_cut(controller);
    Input held = in_contact();
    held.feed_hold = true;
    const float before = controller.step(held).ratio;
    held.cut = in_air().cut;        // a tool that stands cuts nothing
    repeat(controller, held, 300);  // moves by 6 mm, and the feed is not free yet
    const Output released = repeat(controller, in_air(), 99);
    CHECK(released.state == CutState::hold);
    CHECK_FALSE(released.hold);
    CHECK(released.ratio <= before);
    CHECK(repeat(controller, in_air(), 3).state == CutState::exit);
    CHECK(repeat(controller, in_contact(), 1).state == CutState::entry);
}

TEST(CutStates, behind_a_hold_without_an_estimate_the_feed_is_held_after_the_exit_travel) {
    Controller controller;
    bring_into_cut(controller);
    Input held = in_contact();
    held.feed_hold = true;
    repeat(controller, held, 10);
    const Input blind = without_force(in_contact());
    const Output before = repeat(controller, blind, 99);
    CHECK_FALSE(before.hold);
    const Output after = repeat(controller, blind, 3);
    CHECK(after.hold);
    CHECK(after.state == CutState::hold);
    const Output seeing = controller.step(in_air());
    CHECK(seeing.state == CutState::exit);
    CHECK_FALSE(seeing.hold);
}

TEST(CutStates, behind_a_hold_that_was_blind_an_estimate_frees_the_feed_of_a_tool_that_may_stand_in_its_cut) {
    Parameters p;
    p.exit_travel_mm = 1.0F;
    Controller controller(p);
    bring_into_cut(controller);
    Input held = in_contact();
    held.feed_hold = true;
    repeat(controller, held, 10);
    Input unseen = without_force(in_contact());
    unseen.path_speed_mm_s = 0.0F;
    unseen.motion_is_unseen = true;  // counts as moving with the programmed feed
    CHECK(repeat(controller, unseen, 200).hold);
    Input at_rest = in_air();
    at_rest.path_speed_mm_s = 0.0F;
    const Output seeing = controller.step(at_rest);
    CHECK(seeing.state == CutState::hold);
    CHECK_FALSE(seeing.hold);  // or nothing would ever move again
    CHECK(controller.step(in_contact()).state == CutState::in_cut);
}

TEST(CutStates, behind_a_hold_out_of_the_cut_or_while_it_begins_the_cutter_enters) {
    Controller in_air_before;
    repeat(in_air_before, in_air(), 10);
    Controller entering;
    repeat(entering, in_contact(), 3);
    CHECK(entering.state() == CutState::entry);
    for (Controller* controller : {&in_air_before, &entering}) {
        Input held = in_contact();
        held.feed_hold = true;
        CHECK(repeat(*controller, held, 10).state == CutState::hold);
        CHECK(controller->step(in_contact()).state == CutState::entry);
    }
}

TEST(CutStates, holds_in_cut_once_the_force_is_missing_for_longer_than_stated) {
    Controller controller;
    bring_into_cut(controller);
    const Input blind = without_force(in_contact());
    CHECK(repeat(controller, blind, 490).state == CutState::in_cut);
    const Output output = repeat(controller, blind, 20);  // 0.5 s and a little
    CHECK(output.state == CutState::hold);
    CHECK(output.hold);
    CHECK(output.fault == Fault::none);
    CHECK(output.limit == Limit::no_estimate);
    CHECK(repeat(controller, blind, 500).state == CutState::hold);
    const Output seeing = controller.step(in_contact());
    CHECK(seeing.state == CutState::entry);
    CHECK_FALSE(seeing.hold);
}

TEST(CutStates, holds_in_air_once_the_tool_was_fed_without_a_force_for_longer_than_the_exit_travel) {
    Controller controller;
    repeat(controller, in_air(), 100);
    const Input blind = without_force(in_air());
    CHECK(repeat(controller, blind, 95).state == CutState::air);  // 1.9 of 2 mm
    const Output output = repeat(controller, blind, 10);
    CHECK(output.state == CutState::hold);
    CHECK(output.hold);
    CHECK(output.fault == Fault::none);
    CHECK_FALSE(controller.step(in_air()).hold);
}

TEST(CutStates, counts_the_programmed_feed_as_travel_where_no_velocity_is_known_either) {
    for (const bool is_unseen : {false, true}) {
        Controller controller;
        Input blind = without_force(in_air());
        blind.path_speed_mm_s = 0.0F;
        blind.motion_is_unseen = is_unseen;
        CHECK(repeat(controller, blind, 200).hold == is_unseen);
    }
}

TEST(CutStates, counts_the_way_of_the_axes_where_the_programmed_feed_is_not_known) {
    Controller controller;
    Input blind = without_force(in_air());
    blind.motion_is_unseen = true;
    blind.programmed_feed_mm_s = not_a_number;
    CHECK(repeat(controller, blind, 200).hold);
}

TEST(CutStates, moves_on_without_a_force_in_a_rapid_and_where_the_spindle_does_not_mill) {
    for (const bool is_rapid : {false, true}) {
        Controller controller;
        Input blind = without_force(in_air());
        blind.cut.spindle_turning = false;
        blind.rapid = is_rapid;
        blind.cut.spindle_does_not_mill = !is_rapid;
        const Output output = repeat(controller, blind, 2000);
        CHECK_FALSE(output.hold);
        CHECK(output.state == CutState::air);
    }
}

TEST(CutStates, a_hold_without_an_estimate_is_not_left_while_the_operator_holds_the_feed) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(repeat(controller, without_force(in_contact()), 510).hold);
    Input held = in_contact();
    held.feed_hold = true;
    repeat(controller, held, 10);
    const Output output = controller.step(without_force(in_contact()));
    CHECK(output.state == CutState::hold);
    CHECK(output.hold);
}

TEST(CutStates, a_cut_that_was_given_up_is_over_once_spindle_and_axes_have_stood_for_two_seconds) {
    Controller controller;
    bring_into_cut(controller);
    Input blind = without_force(in_contact());
    CHECK(repeat(controller, blind, 600).hold);
    blind.rapid = true;  // nothing is in the way, says the program
    CHECK_FALSE(controller.step(blind).hold);
    blind.rapid = false;
    blind.path_speed_mm_s = 0.0F;
    CHECK(repeat(controller, blind, 3000).hold);  // the spindle turns
    blind.cut.spindle_turning = false;
    CHECK(repeat(controller, blind, 1900).hold);
    const Output over = repeat(controller, blind, 200);
    CHECK(over.state == CutState::air);
    CHECK_FALSE(over.hold);
}

TEST(CutStates, a_hold_of_the_operator_does_not_outlast_itself_where_the_spindle_stands) {
    Controller controller;
    Input held = without_force(in_air());
    held.cut.spindle_turning = false;
    held.feed_hold = true;
    CHECK(repeat(controller, held, 100).hold);
    held.feed_hold = false;
    CHECK_FALSE(controller.step(held).hold);
}

TEST(CutStates, a_cut_that_was_given_up_is_not_over_while_the_axes_move) {
    Controller controller;
    bring_into_cut(controller);
    Input blind = without_force(in_contact());
    CHECK(repeat(controller, blind, 600).state == CutState::hold);
    blind.cut.spindle_turning = false;
    CHECK(repeat(controller, blind, 3000).state != CutState::air);
}

TEST(CutStates, a_hold_of_the_operator_lasts_however_long_spindle_and_axes_stand) {
    Controller controller;
    Input held = in_air();
    held.cut.spindle_turning = false;
    held.path_speed_mm_s = 0.0F;
    held.feed_hold = true;
    CHECK(repeat(controller, held, 5000).state == CutState::hold);
}

TEST(CutStates, a_cut_whose_force_is_known_is_not_over_though_spindle_and_axes_stand) {
    Controller controller;
    bring_into_cut(controller);
    Input standing = in_contact();
    standing.cut.spindle_turning = false;
    standing.path_speed_mm_s = 0.0F;
    CHECK(repeat(controller, standing, 5000).state == CutState::in_cut);
}
