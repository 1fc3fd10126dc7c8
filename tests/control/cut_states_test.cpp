// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Output into_overload(Controller& controller) {
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 1351.0F;
    return repeat(controller, heavy, 13);
}

}  // namespace

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
        CHECK(released.state == (cutting ? CutState::entry : CutState::exit));
        CHECK_FALSE(released.hold);
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

TEST(CutStates, moves_on_without_a_force_in_a_rapid_and_where_the_spindle_stands) {
    for (const bool is_rapid : {false, true}) {
        Controller controller;
        Input blind = without_force(in_air());
        blind.cut.spindle_turning = false;
        blind.rapid = is_rapid;
        blind.cut.spindle_stands = !is_rapid;
        CHECK_FALSE(repeat(controller, blind, 2000).hold);
    }
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

TEST_GROUP(Faults){};

TEST(Faults, overload_latches_after_more_than_the_stated_revolutions) {
    Controller controller;
    bring_into_cut(controller);
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 1351.0F;                          // 1.35 times 1000 N
    CHECK(repeat(controller, heavy, 12).fault == Fault::none);  // three revolutions of four teeth
    const Output output = controller.step(heavy);
    CHECK(output.fault == Fault::overload);
    CHECK(output.state == CutState::fault);
    CHECK(output.hold);
    const Output later = repeat(controller, in_air(), 200);
    CHECK(later.fault == Fault::overload);
    CHECK(later.hold);
    DOUBLES_EQUAL(0.1, static_cast<double>(later.ratio), 1e-6);
}

TEST(Faults, overload_is_forgotten_by_one_tooth_below_it_and_does_not_count_old_estimates) {
    Controller controller;
    bring_into_cut(controller);
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 2000.0F;
    for (int k = 0; k < 20; ++k) {
        CHECK(repeat(controller, heavy, 12).fault == Fault::none);
        CHECK(controller.step(in_contact()).fault == Fault::none);
    }
    repeat(controller, heavy, 12);
    heavy.cut.fresh = false;
    CHECK(repeat(controller, heavy, 100).fault == Fault::none);
}

TEST(Faults, one_estimate_is_a_revolution_of_overload_however_many_teeth_have_passed_since_the_last) {
    Controller controller;
    bring_into_cut(controller);
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 2000.0F;
    heavy.cut.tooth_periods = 40.0F;
    CHECK(repeat(controller, heavy, 3).fault == Fault::none);
    CHECK(controller.step(heavy).fault == Fault::overload);
}

TEST(Faults, a_guessed_tooth_force_is_no_overload_but_lowers_the_feed) {
    for (const bool is_bound : {false, true}) {
        Controller controller;
        bring_into_cut(controller);
        Input guessed = in_contact();
        guessed.cut.tooth_force_valid = is_bound;
        guessed.cut.tooth_force_is_bound = is_bound;
        guessed.cut.tooth_force_N = 2000.0F;
        const Output output = repeat(controller, guessed, 1000);
        CHECK(output.fault == Fault::none);
        const float law = std::pow(970.0F / 2000.0F, 1.0F / 0.75F);
        DOUBLES_EQUAL(static_cast<double>(law), static_cast<double>(output.ratio), 1e-5);
    }
}

TEST(Faults, a_cutter_that_enters_goes_no_slower_than_the_entry_feed_but_for_a_force_that_is_certain) {
    Parameters p;
    p.entry_travel_mm = 1000.0F;
    Controller controller(p);
    Input guessed = in_contact();
    guessed.cut.tooth_force_is_bound = true;
    guessed.cut.tooth_force_N = 2000.0F;
    const Output output = repeat(controller, guessed, 1000);
    CHECK(output.state == CutState::entry);
    DOUBLES_EQUAL(static_cast<double>(ratio_of(p.entry_feed_per_tooth_mm, guessed)), static_cast<double>(output.ratio),
                  1e-4);
    guessed.cut.least_tooth_force_N = 2000.0F;
    const float law = std::pow(970.0F / 2000.0F, 1.0F / 0.75F);
    DOUBLES_EQUAL(static_cast<double>(law), static_cast<double>(repeat(controller, guessed, 100).ratio), 1e-5);
}

TEST(Faults, stale_input_latches_in_every_state) {
    for (const float silent_s : {0.0501F, 1e9F, beyond_all, not_a_number}) {
        for (const int steps_before : {0, 1, 400}) {
            Controller controller;
            repeat(controller, in_contact(), steps_before);
            Input input = in_contact();
            input.time_since_sample_s = 0.0499F;
            CHECK(controller.step(input).fault == Fault::none);
            input.time_since_sample_s = silent_s;
            const Output output = controller.step(input);
            CHECK(output.fault == Fault::stale_input);
            CHECK(output.hold);
            const Output later = repeat(controller, in_contact(), 100);
            CHECK(later.fault == Fault::stale_input);
            DOUBLES_EQUAL(0.1, static_cast<double>(later.ratio), 1e-6);
        }
    }
}

TEST(Faults, a_spindle_that_stops_in_cut_while_the_tool_moves_is_a_fault) {
    Controller controller;
    bring_into_cut(controller);
    Input stopped = without_force(in_contact());
    stopped.cut.fresh = false;
    stopped.cut.spindle_turning = false;
    CHECK(repeat(controller, stopped, 49).fault == Fault::none);
    const Output output = repeat(controller, stopped, 3);
    CHECK(output.fault == Fault::spindle_stopped);
    CHECK(output.hold);
}

TEST(Faults, a_spindle_that_stops_in_air_or_with_the_tool_at_rest_is_none) {
    Input stopped = without_force(in_air());
    stopped.cut.spindle_turning = false;
    Controller in_air_controller;
    CHECK(repeat(in_air_controller, stopped, 400).fault == Fault::none);
    Controller at_rest;
    bring_into_cut(at_rest);
    stopped.path_speed_mm_s = 0.0F;
    CHECK(repeat(at_rest, stopped, 400).fault == Fault::none);
}

TEST(Faults, reset_leaves_a_fault_for_air_at_the_lowest_override) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(into_overload(controller).fault == Fault::overload);
    controller.reset();
    CHECK(controller.state() == CutState::air);
    const Output output = controller.step(in_air());
    CHECK(output.fault == Fault::none);
    CHECK_FALSE(output.hold);
    CHECK(output.ratio < 0.11F);
}

namespace {

void check_bad(const char* what, void (*spoil)(Parameters&, float), std::initializer_list<float> values) {
    for (const float value : values) {
        Parameters p;
        spoil(p, value);
        Controller controller(p);
        for (int attempt = 0; attempt < 2; ++attempt) {
            for (const Input& input : {in_contact(), in_air(), without_force(in_contact())}) {
                const Output output = repeat(controller, input, 50);
                CHECK_TEXT(output.fault == Fault::bad_configuration, what);
                CHECK_TEXT(output.state == CutState::fault, what);
                CHECK_TEXT(output.hold, what);
                CHECK_TEXT(output.ratio == 0.0F, what);
            }
            controller.reset();  // changes nothing: the parameters are still bad
        }
    }
}

}  // namespace

TEST(Faults, bad_configuration_gives_ratio_0_and_hold_for_good) {
    check_bad("limit", [](Parameters& p, float v) { p.tooth_force_limit_N = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("minimum", [](Parameters& p, float v) { p.override_min = v; },
              {-0.1F, 1.5F, 2.0F, not_a_number, beyond_all});
    check_bad("maximum", [](Parameters& p, float v) { p.override_max = v; },
              {0.1F, 0.0F, 10.0F, not_a_number, beyond_all});
    check_bad("set point", [](Parameters& p, float v) { p.setpoint_share = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("slew up", [](Parameters& p, float v) { p.slew_up_per_s = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("slew down", [](Parameters& p, float v) { p.slew_down_per_s = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("teeth", [](Parameters& p, float v) { p.teeth = v; }, {0.0F, -4.0F, not_a_number});
    check_bad("entry", [](Parameters& p, float v) { p.entry_feed_per_tooth_mm = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("air", [](Parameters& p, float v) { p.air_feed_per_tooth_mm = v; }, {0.0F, -1.0F, not_a_number});
    check_bad("feed", [](Parameters& p, float v) { p.max_feed_per_tooth_mm = v; }, {0.0F, -1.0F, not_a_number});
}

TEST(Faults, a_negative_largest_override_gives_ratio_0_as_any_bad_configuration) {
    check_bad("maximum", [](Parameters& p, float v) { p.override_max = v; }, {-1.0F, -beyond_all});
}
