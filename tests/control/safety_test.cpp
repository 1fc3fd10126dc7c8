// SPDX-License-Identifier: Apache-2.0
#include "feed_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::control;
using namespace millforce::control::bench;

namespace {

Input anything(Dice& dice) {
    Input input = in_contact();
    float* const fields[] = {&input.dt_s,
                             &input.programmed_feed_mm_s,
                             &input.operator_override,
                             &input.path_speed_mm_s,
                             &input.cut.tangential_N,
                             &input.cut.tangential_sd_N,
                             &input.cut.tooth_force_N,
                             &input.cut.surge_ratio,
                             &input.cut.cutting_share,
                             &input.cut.surge_cutting_share,
                             &input.cut.feed_exponent,
                             &input.cut.feed_mm_s,
                             &input.cut.spindle_speed_rad_s};
    for (float* field : fields) {
        *field = dice.one_in(3) ? dice.anything() : *field;
    }
    input.time_since_sample_s = dice.one_in(200) ? dice.anything() : 0.0F;
    input.rapid = dice.one_in(8);
    input.plunging = dice.one_in(8);
    input.feed_hold = dice.one_in(16);
    input.cut.fresh = !dice.one_in(3);
    input.cut.force_valid = !dice.one_in(4);
    input.cut.tooth_force_valid = !dice.one_in(4);
    input.cut.spindle_turning = !dice.one_in(8);
    return input;
}

/// What a sound machine may show from one tick to the next, in any order.
Input plausible(Dice& dice) {
    Input input = dice.one_in(6) ? in_air() : in_contact();
    input.programmed_feed_mm_s = dice.between(5.0F, 40.0F);
    input.path_speed_mm_s = dice.between(0.0F, 40.0F);
    input.cut.feed_mm_s = input.path_speed_mm_s;
    input.cut.spindle_speed_rad_s = dice.between(400.0F, 1000.0F);  // none that stalls
    input.cut.tooth_force_N *= dice.between(0.2F, 2.5F);
    input.cut.cutting_share = dice.between(0.3F, 1.0F);
    input.cut.fresh = !dice.one_in(3);
    input.cut.tooth_force_valid = !dice.one_in(3);
    input.plunging = dice.one_in(10);
    return dice.one_in(4) ? without_force(input) : input;
}

Parameters quick_entry() {
    Parameters p;
    p.entry_travel_mm = 0.1F;
    p.entry_revolutions = 0.5F;
    p.surge_radial_immersion = 1.0F;
    return p;
}

bool is_cutting_or_held(CutState state) {
    return state == CutState::entry || state == CutState::in_cut || state == CutState::hold;
}

}  // namespace

TEST_GROUP(Safety){};

TEST(Safety, the_ratio_is_finite_and_within_its_limits_whatever_comes_in) {
    Dice dice(20240607);
    for (const bool monitor_only : {false, true}) {
        Parameters p = quick_entry();
        p.monitor_only = monitor_only;
        Controller controller(p);
        int not_in_fault = 0;
        for (int k = 0; k < 100000; ++k) {
            const Output output = controller.step(anything(dice));
            CHECK(output.ratio >= p.override_min && output.ratio <= p.override_max);
            CHECK(output.hold || output.state != CutState::fault);
            not_in_fault += output.state != CutState::fault ? 1 : 0;
            if (dice.one_in(30)) {
                controller.reset();
            }
        }
        CHECK(not_in_fault > 20000);
    }
}

TEST(Safety, each_single_spoilt_field_leaves_the_ratio_finite_and_within_its_limits) {
    float Input::*const own[] = {&Input::dt_s, &Input::programmed_feed_mm_s, &Input::operator_override,
                                 &Input::path_speed_mm_s, &Input::time_since_sample_s};
    using Cut = CutEstimateForControl<float>;
    float Cut::*const of_cut[] = {&Cut::tangential_N,  &Cut::tangential_sd_N, &Cut::tooth_force_N,
                                  &Cut::surge_ratio,   &Cut::cutting_share,   &Cut::surge_cutting_share,
                                  &Cut::feed_exponent, &Cut::feed_mm_s,       &Cut::spindle_speed_rad_s};
    const auto survives = [](const Input& spoilt) {
        Controller controller(quick_entry());
        bring_into_cut(controller);
        for (int k = 0; k < 20; ++k) {
            const float ratio = controller.step(k % 2 == 0 ? spoilt : in_contact()).ratio;
            CHECK(ratio >= 0.1F && ratio <= 1.5F);
        }
    };
    for (const float value : {not_a_number, beyond_all, -beyond_all, -1.0F, 0.0F}) {
        for (const auto field : own) {
            Input input = in_contact();
            input.*field = value;
            survives(input);
        }
        for (const auto field : of_cut) {
            Input input = in_contact();
            input.cut.*field = value;
            survives(input);
        }
    }
}

TEST(Safety, no_estimate_no_rise_in_ten_thousand_cuts) {
    Dice dice(77);
    int without = 0;
    for (int sequence = 0; sequence < 10000; ++sequence) {
        Controller controller(quick_entry());
        float before = controller.step(in_contact()).ratio;
        for (int k = 0; k < 60; ++k) {
            const Input input = plausible(dice);
            const Output output = controller.step(input);
            const bool estimated = input.cut.force_valid && input.cut.tooth_force_valid;
            if (!estimated && is_cutting_or_held(output.state)) {
                CHECK(output.ratio <= before);
                ++without;
            }
            before = output.ratio;
        }
    }
    CHECK(without > 50000);
}

TEST(Safety, a_gap_in_the_cut_raises_nothing_above_the_feed_before_it) {
    Dice dice(78);
    for (int sequence = 0; sequence < 1000; ++sequence) {
        Controller controller(quick_entry());
        Input input = in_contact();
        input.cut.tooth_force_N = dice.between(600.0F, 1300.0F);
        const float before = repeat(controller, input, 300).ratio;
        Output output = controller.step(in_air());
        while (output.state == CutState::exit) {
            CHECK(output.ratio <= before);
            output = controller.step(in_air());
        }
        CHECK(output.state == CutState::air);
    }
}

TEST(Safety, an_estimate_is_good_for_a_rise_of_one_revolution) {
    Controller controller;
    Input light = in_contact();
    light.cut.tooth_force_N = 300.0F;
    const float before = bring_into_cut(controller, light).ratio;
    light.cut.fresh = false;
    const float after_a_revolution = repeat(controller, light, 16).ratio;  // of 15.7 ms
    CHECK(after_a_revolution > before);
    DOUBLES_EQUAL(static_cast<double>(after_a_revolution), static_cast<double>(repeat(controller, light, 500).ratio),
                  0.0);
    light.cut.fresh = true;
    CHECK(controller.step(light).ratio > after_a_revolution);
}

TEST(Safety, a_fall_waits_for_no_estimate) {
    Controller controller;
    Input input = in_contact();
    bring_into_cut(controller, input);
    const float before = repeat(controller, input, 200).ratio;
    input.cut.fresh = false;
    repeat(controller, input, 100);
    input.operator_override = 0.5F * before;
    CHECK(repeat(controller, input, 100).ratio <= 0.5F * before);
}

TEST(Safety, no_spindle_speed_no_rise) {
    for (const float speed_rad_s : {0.0F, -400.0F, not_a_number}) {
        for (const Input& start : {in_air(), in_contact()}) {
            Controller controller;
            const float before = repeat(controller, start, 20).ratio;
            Input unknown = without_force(start);
            unknown.cut.fresh = false;
            unknown.cut.spindle_speed_rad_s = speed_rad_s;
            CHECK(repeat(controller, unknown, 300).ratio <= before);
        }
    }
}

namespace {

/// A heavy cut at its set point; then one field of the estimate is spoilt for one step.
template <typename Spoil>
bool rises_after(Spoil spoil) {
    Controller controller(quick_entry());
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 960.0F;
    const float before = repeat(controller, heavy, 500).ratio;
    spoil(heavy.cut);
    return controller.step(heavy).ratio > before;
}

}  // namespace

TEST(Safety, an_unknown_tooth_force_raises_nothing) {
    CHECK_FALSE(rises_after([](auto& cut) { cut.tooth_force_N = not_a_number; }));
    CHECK_FALSE(rises_after([](auto& cut) { cut.tooth_force_N = beyond_all; }));
    CHECK_FALSE(rises_after([](auto& cut) { cut.tooth_force_N = -960.0F; }));
}

TEST(Safety, an_unknown_share_of_cutting_raises_nothing) {
    CHECK_FALSE(rises_after([](auto& cut) { cut.cutting_share = not_a_number; }));
}

TEST(Safety, an_unknown_exponent_raises_nothing) {
    CHECK_FALSE(rises_after([](auto& cut) { cut.feed_exponent = not_a_number; }));
}

TEST(Safety, an_unknown_or_infinite_feed_raises_nothing) {
    CHECK_FALSE(rises_after([](auto& cut) { cut.feed_mm_s = not_a_number; }));
    CHECK_FALSE(rises_after([](auto& cut) { cut.feed_mm_s = beyond_all; }));
}

TEST(Safety, an_unknown_spindle_speed_raises_nothing_in_cut) {
    CHECK_FALSE(rises_after([](auto& cut) { cut.spindle_speed_rad_s = not_a_number; }));
}

TEST(Safety, the_override_keeps_its_slew_limits_at_each_step) {
    Dice dice(5);
    const Parameters p = quick_entry();
    Controller controller(p);
    float before = p.override_min;
    int rises = 0;
    int falls = 0;
    for (int k = 0; k < 100000; ++k) {
        Input input = anything(dice);
        input.dt_s = dice.between(0.0F, 0.01F);
        input.time_since_sample_s = 0.0F;
        input.cut.spindle_speed_rad_s = std::fabs(input.cut.spindle_speed_rad_s);
        const Output output = controller.step(input);
        CHECK(output.ratio - before <= p.slew_up_per_s * input.dt_s + 1e-6F);
        CHECK(before - output.ratio <= p.slew_down_per_s * input.dt_s + 1e-6F);
        rises += output.ratio > before ? 1 : 0;
        falls += output.ratio < before ? 1 : 0;
        before = output.ratio;
        if (output.state == CutState::fault) {
            controller.reset();
            before = p.override_min;
        }
    }
    CHECK(rises > 1000);
    CHECK(falls > 1000);
}

TEST(Safety, a_spindle_turning_backwards_breaks_no_slew_limit) {
    Controller controller(quick_entry());
    Input backwards = in_contact();
    backwards.cut.tooth_force_N = 960.0F;
    const float before = repeat(controller, backwards, 500).ratio;
    backwards.cut.spindle_speed_rad_s = -1e6F;
    CHECK(before - controller.step(backwards).ratio <= 0.040001F);
}

namespace {

bool rises_in_a_step_of(float dt_s, float force_N) {
    Controller controller(quick_entry());
    Input input = in_contact();
    input.cut.tooth_force_N = 960.0F;
    const float before = repeat(controller, input, 500).ratio;
    input.dt_s = dt_s;
    input.cut.tooth_force_N = force_N;
    return controller.step(input).ratio > before;
}

}  // namespace

TEST(Safety, a_step_of_no_length_raises_nothing) {
    CHECK_FALSE(rises_in_a_step_of(0.0F, 300.0F));
    CHECK_FALSE(rises_in_a_step_of(0.0F, 1300.0F));
}

TEST(Safety, a_step_of_a_second_or_more_raises_nothing) {
    CHECK_TRUE(rises_in_a_step_of(0.9F, 300.0F));
    CHECK_FALSE(rises_in_a_step_of(1.0F, 300.0F));
    CHECK_FALSE(rises_in_a_step_of(5.0F, 300.0F));
}

TEST(Safety, a_feed_that_was_not_known_for_a_step_leaves_no_demand_behind) {
    Controller controller(quick_entry());
    Input heavy = in_contact();
    heavy.cut.tooth_force_N = 960.0F;
    const float before = repeat(controller, heavy, 500).ratio;
    heavy.programmed_feed_mm_s = 0.0F;
    controller.step(heavy);
    heavy.programmed_feed_mm_s = in_contact().programmed_feed_mm_s;
    heavy.cut.fresh = false;
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(controller.step(heavy).ratio), 1e-3);
}

TEST(Safety, a_feed_that_is_told_no_more_raises_nothing_and_still_falls_before_the_force) {
    for (const float untold : {0.0F, not_a_number}) {
        Controller controller(quick_entry());
        Input input = in_contact();
        input.cut.tooth_force_N = 960.0F;
        const float before = repeat(controller, input, 500).ratio;
        input.programmed_feed_mm_s = untold;
        input.cut.tooth_force_N = 300.0F;
        CHECK_COMPARE(repeat(controller, input, 500).ratio, <=, before);
        input.cut.tooth_force_N = 1300.0F;
        CHECK_COMPARE(repeat(controller, input, 500).ratio, <, 0.9F * before);
    }
}

TEST(Safety, a_step_of_unknown_length_raises_nothing) {
    CHECK_FALSE(rises_in_a_step_of(not_a_number, 300.0F));
}

TEST(Safety, a_step_of_negative_length_raises_nothing) {
    CHECK_FALSE(rises_in_a_step_of(-0.001F, 300.0F));
    CHECK_FALSE(rises_in_a_step_of(-0.001F, 1300.0F));
}

TEST(Safety, the_operators_override_below_1_always_wins) {
    Dice dice(9);
    for (int sequence = 0; sequence < 2000; ++sequence) {
        Parameters p = quick_entry();
        p.slew_down_per_s = 1e5F;
        Controller controller(p);
        for (int k = 0; k < 50; ++k) {
            Input input = plausible(dice);
            input.rapid = dice.one_in(4);
            input.feed_hold = dice.one_in(10);
            input.operator_override = dice.between(-0.2F, 0.999F);
            const float most = std::fmax(input.operator_override, p.override_min);
            CHECK(controller.step(input).ratio <= most);
        }
    }
}

TEST(Safety, the_override_falls_to_the_operators_at_its_full_slew) {
    Controller controller;
    bring_into_cut(controller);
    const float before = repeat(controller, in_contact(), 2000).ratio;
    Input input = in_contact();
    input.operator_override = 0.5F;
    DOUBLES_EQUAL(static_cast<double>(before - 0.04F), static_cast<double>(controller.step(input).ratio), 1e-5);
    const Output output = repeat(controller, input, 40);
    DOUBLES_EQUAL(0.5, static_cast<double>(output.ratio), 1e-6);
    CHECK(output.limit == Limit::operator_limit);
}

TEST(Safety, an_operators_override_below_the_lowest_is_reported_as_the_operators) {
    Controller controller;
    Input input = in_contact();
    input.operator_override = 0.0F;
    const Output output = repeat(controller, input, 100);
    DOUBLES_EQUAL(0.1, static_cast<double>(output.ratio), 1e-6);
    CHECK(output.limit == Limit::operator_limit);
}

TEST(Safety, an_operators_override_that_is_no_number_counts_as_the_lowest) {
    for (const float value : {not_a_number, beyond_all, -beyond_all, -3.0F}) {
        Controller controller;
        bring_into_cut(controller);
        Input input = in_contact();
        input.operator_override = value;
        DOUBLES_EQUAL(0.1, static_cast<double>(repeat(controller, input, 100).ratio), 1e-6);
    }
}
