// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Input in_contact_with(float tooth_force_N) {
    Input input = in_contact();
    input.cut.tooth_force_N = tooth_force_N;
    input.cut.certain_tooth_force_N = tooth_force_N;
    return input;
}

Output into_overload(Controller& controller) {
    return repeat(controller, in_contact_with(1351.0F), 13);
}

}  // namespace

TEST_GROUP(Faults){};

TEST(Faults, overload_latches_after_more_than_the_stated_revolutions) {
    Controller controller;
    bring_into_cut(controller);
    const Input heavy = in_contact_with(1351.0F);               // 1.35 times 1000 N
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

TEST(Faults, an_overload_is_none_before_a_lower_override_has_acted) {
    Parameters p;
    p.reaction_s = 0.1F;  // 25.5 tooth periods
    Controller controller(p);
    bring_into_cut(controller);
    Input heavy = in_contact_with(1351.0F);
    CHECK(repeat(controller, heavy, 12 + 25).fault == Fault::none);
    CHECK(controller.step(heavy).fault == Fault::overload);
    controller.reset();
    bring_into_cut(controller);
    heavy.cut.spindle_speed_rad_s = not_a_number;  // nobody knows how many revolutions that takes
    CHECK(repeat(controller, heavy, 12).fault == Fault::none);
    CHECK(controller.step(heavy).fault == Fault::overload);
}

TEST(Faults, an_overload_that_is_only_forecast_or_possible_is_none) {
    Controller controller;
    bring_into_cut(controller);
    Input growing = in_contact_with(1500.0F);
    growing.cut.certain_tooth_force_N = 1349.0F;
    CHECK(repeat(controller, growing, 100).fault == Fault::none);
    growing.cut.certain_tooth_force_N = 1351.0F;
    CHECK(repeat(controller, growing, 100).fault == Fault::overload);
}

TEST(Faults, an_overload_is_none_where_the_override_is_the_operators) {
    Parameters p;
    p.monitor_only = true;
    Controller controller(p);
    bring_into_cut(controller);
    const Output output = repeat(controller, in_contact_with(2000.0F), 100);
    CHECK(output.fault == Fault::none);
    CHECK(output.state == CutState::in_cut);
}

TEST(Faults, overload_is_forgotten_by_one_tooth_below_it_and_does_not_count_old_estimates) {
    Controller controller;
    bring_into_cut(controller);
    Input heavy = in_contact_with(2000.0F);
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
    Input heavy = in_contact_with(2000.0F);
    heavy.cut.tooth_periods = 40.0F;
    CHECK(repeat(controller, heavy, 3).fault == Fault::none);
    CHECK(controller.step(heavy).fault == Fault::overload);
}

TEST(Faults, a_guessed_tooth_force_is_no_overload_but_lowers_the_feed) {
    for (const bool is_bound : {false, true}) {
        Controller controller;
        bring_into_cut(controller);
        Input guessed = in_contact_with(2000.0F);
        guessed.cut.tooth_force_valid = is_bound;
        guessed.cut.tooth_force_is_bound = is_bound;
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

TEST(Faults, an_encoder_that_stands_in_air_while_the_current_shows_a_cut_is_a_stopped_spindle) {
    Controller controller;
    Input stopped = in_air();
    stopped.cut.spindle_turning = false;
    CHECK(repeat(controller, stopped, 100).fault == Fault::none);
    stopped.cut.spindle_loaded_at_rest = true;
    CHECK(repeat(controller, stopped, 49).fault == Fault::none);
    CHECK(repeat(controller, stopped, 4).fault == Fault::spindle_stopped);
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

TEST(Faults, a_force_on_a_tooth_without_a_valid_force_behind_it_is_no_overload) {
    Controller controller;
    bring_into_cut(controller);
    Input heavy = in_contact_with(1351.0F);
    heavy.cut.force_valid = false;
    CHECK(repeat(controller, heavy, 100).fault == Fault::none);
}

TEST(Faults, what_the_supervisor_of_the_signals_has_found_latches) {
    for (const Fault found : {Fault::signal_stuck, Fault::force_vanished, Fault::idle_torque}) {
        Controller controller;
        Input input = in_contact();
        input.implausible = found;
        CHECK(controller.step(input).fault == found);
        CHECK(repeat(controller, in_contact(), 10).fault == found);
    }
}

TEST(Faults, a_fault_lowers_the_override_though_it_is_only_watched) {
    Parameters p;
    p.monitor_only = true;
    Controller controller(p);
    Input input = in_contact();
    CHECK(repeat(controller, input, 100).ratio == 1.0F);
    input.implausible = Fault::signal_stuck;
    const Output output = repeat(controller, input, 200);
    CHECK(output.hold);
    DOUBLES_EQUAL(static_cast<double>(p.override_min), static_cast<double>(output.ratio), 0.0);
}

TEST(Faults, a_fault_is_not_left_by_a_feed_hold_nor_by_another_fault) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(into_overload(controller).fault == Fault::overload);
    Input held = in_contact();
    held.feed_hold = true;
    held.implausible = Fault::signal_stuck;
    const Output output = repeat(controller, held, 10);
    CHECK(output.state == CutState::fault);
    CHECK(output.fault == Fault::overload);
    CHECK(repeat(controller, in_air(), 10).state == CutState::fault);
}

TEST(Faults, reset_leaves_a_fault_at_the_lowest_override_until_the_tool_has_moved) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(into_overload(controller).fault == Fault::overload);
    controller.reset();
    CHECK(controller.state() == CutState::hold);
    const Output output = repeat(controller, in_air(), 50);  // 1 mm, half the exit travel
    CHECK(output.fault == Fault::none);
    CHECK_FALSE(output.hold);
    CHECK(output.ratio < 0.11F);
    CHECK(repeat(controller, in_air(), 52).state == CutState::exit);
    CHECK(repeat(controller, in_air(), 102).state == CutState::air);
}

TEST(Faults, behind_a_reset_a_tool_that_stands_in_its_cut_is_in_the_cut_and_does_not_enter_it) {
    Controller controller;
    bring_into_cut(controller);
    CHECK(into_overload(controller).fault == Fault::overload);
    controller.reset();
    Input at_rest = in_air();
    at_rest.path_speed_mm_s = 0.0F;
    CHECK(repeat(controller, at_rest, 1000).state == CutState::hold);
    CHECK(controller.step(in_contact()).state == CutState::in_cut);
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

TEST(Faults, each_parameter_below_its_range_or_not_finite_is_a_bad_configuration) {
    const auto is_refused = [](float Parameters::*parameter, float value) {
        Parameters p;
        p.*parameter = value;
        return Controller(p).step(in_air()).fault == Fault::bad_configuration;
    };
    for (float Parameters::*const positive :
         {&Parameters::tooth_force_limit_N, &Parameters::setpoint_share, &Parameters::recovery_per_rev,
          &Parameters::slew_up_per_s, &Parameters::slew_down_per_s, &Parameters::entry_feed_per_tooth_mm,
          &Parameters::air_feed_per_tooth_mm, &Parameters::max_feed_per_tooth_mm, &Parameters::contact_force_N,
          &Parameters::surge_share, &Parameters::depth_step_share, &Parameters::overload_share, &Parameters::stale_s,
          &Parameters::teeth}) {
        for (const float value : {0.0F, -1.0F, not_a_number, beyond_all}) {
            CHECK_TRUE(is_refused(positive, value));
        }
    }
    for (float Parameters::*const not_negative :
         {&Parameters::caution_sd, &Parameters::override_min, &Parameters::highest_programmed_feed_mm_s,
          &Parameters::entry_revolutions, &Parameters::entry_travel_mm, &Parameters::exit_travel_mm,
          &Parameters::contact_significance, &Parameters::surge_radial_immersion, &Parameters::turn_radial_immersion,
          &Parameters::turn_travel_mm, &Parameters::overload_revolutions, &Parameters::reaction_s,
          &Parameters::no_estimate_hold_s, &Parameters::Ra_limit_um, &Parameters::proven_override,
          &Parameters::safe_override}) {
        for (const float value : {-0.01F, not_a_number, beyond_all}) {
            CHECK_TRUE(is_refused(not_negative, value));
        }
        CHECK_FALSE(is_refused(not_negative, 0.0F));
    }
    for (const float value : {0.0F, 0.99F, not_a_number, beyond_all}) {
        CHECK_TRUE(is_refused(&Parameters::depth_step_ratio, value));
    }
    CHECK_TRUE(is_refused(&Parameters::teeth, 0.9F));
    CHECK_FALSE(is_refused(&Parameters::teeth, 1.0F));
}

TEST(Faults, a_negative_largest_override_gives_ratio_0_as_any_bad_configuration) {
    check_bad("maximum", [](Parameters& p, float v) { p.override_max = v; }, {-1.0F, -beyond_all});
}
