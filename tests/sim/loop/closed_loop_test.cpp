// SPDX-License-Identifier: Apache-2.0
#include "control/cut_state.hpp"
#include "loop/bounds.hpp"
#include "loop/ensemble.hpp"
#include "loop/simulation.hpp"
#include "sim/converter_load.hpp"
#include "sim/without_axis_currents.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

using namespace millforce::sim;

namespace {

struct Conditions {
    double cutting_force_scale = 1.0;
    double friction_scale = 1.0;
    std::uint64_t seed = 1;
};

Scenario scenario_named(const std::string& name, const Conditions& conditions = {}) {
    Scenario scenario = read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml");
    scenario.deviation.cutting_force_scale = conditions.cutting_force_scale;
    scenario.deviation.friction_scale = conditions.friction_scale;
    scenario.seed = conditions.seed;
    return scenario;
}

RunFigures controlled(const Scenario& scenario) {
    MillforceController controller(scenario.parameters);
    return simulate(scenario, controller, "millforce").result.figures;
}

/// Peak at most 10 % over the tooth's limit, and above it only within the reaction time after the engagement grew; no
/// tooth broken, the part finished: for K_s off by ± 30 % and friction by ± 20 % from what was calibrated, current
/// noise 1 % of rated current.
void holds_the_limit(const std::string& name) {
    for (const Conditions& conditions :
         {Conditions{1.0, 1.0, 1}, Conditions{1.3, 0.8, 2}, Conditions{1.3, 1.2, 3}, Conditions{0.7, 1.2, 4}}) {
        const RunFigures figures = controlled(scenario_named(name, conditions));
        STRCMP_EQUAL("none", figures.fault.c_str());
        CHECK(bounds_hold(figures));
        CHECK(figures.peak_over_limit > 0.5);  // the limit is used, too
    }
}

/// The 95 % bands over plants drawn from the stated deviations; 12 plants leave some per cent to chance. Returns how
/// often that of the immersion holds.
double bands_hold(const std::string& name) {
    const EnsembleFigures figures = summarise_ensemble(run_ensemble(scenario_named(name), 12));
    CHECK(figures.immersion_coverage >= 0.90);
    CHECK(figures.depth_coverage >= 0.88);
    LONGS_EQUAL(0, figures.teeth_broken);
    return figures.immersion_coverage;
}

/// Against the constant feed that is safe for a material up to 30 % harder.
double time_saved(const std::string& name) {
    const Scenario scenario = scenario_named(name);
    ConstantFeed constant(scenario.parameters, safe_constant_override(scenario));
    const RunFigures baseline = simulate(scenario, constant, "constant").result.figures;
    return 1.0 - controlled(scenario).time_s / baseline.time_s;
}

}  // namespace

TEST_GROUP(ClosedLoop){};

TEST(ClosedLoop, holds_the_limit_over_a_width_step) {
    holds_the_limit("width_step");
}
TEST(ClosedLoop, holds_the_limit_entering_a_slot_head_on) {
    holds_the_limit("slot_entry");
}
TEST(ClosedLoop, holds_the_limit_over_a_depth_ramp) {
    holds_the_limit("depth_ramp");
}
TEST(ClosedLoop, holds_the_limit_in_an_interrupted_cut) {
    holds_the_limit("interrupted");
}
TEST(ClosedLoop, holds_the_limit_with_a_face_mill_over_a_varying_width) {
    holds_the_limit("face_mill");
}

TEST(ClosedLoop, holds_the_limit_with_a_face_mill_over_the_middle) {
    holds_the_limit("face_mill_centred");
}

TEST(ClosedLoop, holds_the_limit_where_force_drops_tell_the_immersion) {
    holds_the_limit("face_mill_dynamometer");
}

TEST(ClosedLoop, knows_the_engagement_better_and_is_faster_with_force_drops) {
    double estimate_share = 0.0;
    double time_told_s = 0.0;
    double time_alone_s = 0.0;
    double alone_share = 0.0;
    constexpr std::uint64_t seeds = 3;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const Scenario with = scenario_named("face_mill_dynamometer", {1.0, 1.0, seed});
        Scenario without = with;
        without.parameters.tool.force_drop.law.largest_immersion = 0.0F;
        const RunFigures told = controlled(with);
        CHECK(told.immersion_rms < 0.05);
        CHECK(told.depth_rms_mm < 0.2);
        estimate_share += told.estimate_share / seeds;
        time_told_s += told.time_s;
        const RunFigures alone = controlled(without);
        time_alone_s += alone.time_s;
        alone_share += alone.estimate_share / seeds;
        CHECK(told.peak_over_limit < alone.peak_over_limit);
        CHECK(told.immersion_rms < 0.25 * alone.immersion_rms);
    }
    CHECK(estimate_share > 0.9);
    CHECK(alone_share < 0.8);
    CHECK(time_told_s < 0.95 * time_alone_s);
}

/// Two machines as they are drawn from the stated deviations. The current of one scatters little before the first cut;
/// the entry of the other leaves open whether the tooth's force is twice the limit or half of it.
TEST(ClosedLoop, does_not_stand_still_on_a_sound_machine) {
    for (const std::uint64_t seed : {35U, 36U}) {
        Scenario scenario = scenario_named("face_mill_dynamometer", {1.0, 1.0, seed});
        scenario.deviation = drawn_deviation(scenario, seed);
        const RunFigures figures = controlled(scenario);
        STRCMP_EQUAL("none", figures.fault.c_str());
        CHECK(bounds_hold(figures));
        CHECK(figures.time_s < 60.0);  // the program takes 46 s at its own feed
        CHECK(figures.estimate_share > 0.85);
    }
}

TEST(ClosedLoop, holds_the_limit_in_a_zig_zag_although_the_tool_file_says_down) {
    holds_the_limit("zigzag");
}

TEST(ClosedLoop, holds_the_limit_in_up_milling_although_the_tool_file_says_down) {
    holds_the_limit("width_step_up");
}

TEST(ClosedLoop, holds_the_limit_on_a_machine_whose_spindle_alone_is_measured) {
    for (const char* name : {"depth_ramp", "width_step", "slot_entry", "interrupted", "zigzag"}) {
        for (const Conditions& conditions : {Conditions{1.0, 1.0, 1}, Conditions{1.3, 0.8, 2}}) {
            Scenario scenario = scenario_named(name, conditions);
            scenario.parameters = millforce::test::without_axis_currents(scenario.parameters);
            const RunFigures figures = controlled(scenario);
            CHECK(bounds_hold(figures));
            STRCMP_EQUAL("none", figures.fault.c_str());
        }
    }
}

TEST(ClosedLoop, holds_the_limit_by_a_converters_load_that_comes_seldom_and_late) {
    struct Source {
        double period_s;
        double age_s;
    };
    for (const char* name : {"depth_ramp", "width_step", "slot_entry"}) {
        for (const Source& source : {Source{0.01, 0.05}, Source{0.1, 0.2}}) {
            for (const Conditions& conditions : {Conditions{1.0, 1.0, 1}, Conditions{1.3, 0.8, 2}}) {
                const Scenario scenario = scenario_named(name, conditions);
                const RunFigures figures =
                    controlled(millforce::test::with_converter_load(scenario, source.period_s, source.age_s));
                CHECK(bounds_hold(figures));
                STRCMP_EQUAL("none", figures.fault.c_str());
            }
        }
    }
}

TEST(ClosedLoop, holds_the_limit_in_a_pocket_of_harder_steel) {
    CHECK(bounds_hold(controlled(scenario_named("pocket", {1.3, 0.8, 2}))));
}

TEST(ClosedLoop, says_law_misfit_where_the_declared_depth_shows_steel_twice_as_hard_as_the_tools) {
    const Scenario scenario = scenario_named("width_step", {.cutting_force_scale = 2.0});
    MillforceController controller(scenario.parameters);
    const auto run = simulate(scenario, controller, "millforce");
    LONGS_EQUAL(0, run.result.figures.teeth_broken);
    const auto is_held = [](const TracePoint& point) {
        return point.limit == static_cast<std::uint8_t>(millforce::control::Limit::law_misfit);
    };
    CHECK(std::ranges::any_of(run.result.trace, is_held));
}

TEST(ClosedLoop, holds_the_limit_in_a_round_pocket_that_is_stepped_over_head_on) {
    CHECK(bounds_hold(controlled(scenario_named("circular", {1.3, 0.8, 2}))));
}

TEST(ClosedLoop, mills_on_a_machine_whose_currents_are_three_times_as_noisy_as_told) {
    for (const char* name : {"circular", "zigzag", "interrupted"}) {
        for (const Conditions& conditions : {Conditions{0.8, 1.1, 3}, Conditions{1.2, 0.9, 4}}) {
            Scenario noisy = scenario_named(name, conditions);
            noisy.deviation.current_noise_share = 0.03;
            const RunFigures figures = controlled(noisy);
            STRCMP_EQUAL("none", figures.fault.c_str());
            CHECK(bounds_hold(figures));
        }
    }
}

TEST(ClosedLoop, holds_the_limit_there_though_nobody_declared_the_steps) {
    Scenario undeclared = scenario_named("circular");
    undeclared.parameters.tool.control.surge_radial_immersion = 0.0F;
    CHECK(bounds_hold(controlled(undeclared)));
}

TEST(ClosedLoop, states_bands_that_hold) {
    double coverage = 0.0;
    for (const char* name : {"depth_ramp", "face_mill", "width_step", "face_mill_dynamometer"}) {
        coverage += bands_hold(name) / 4.0;
    }
    CHECK(coverage < 0.999);  // bands that always hold are too wide
}

TEST(ClosedLoop, takes_no_rapid_and_no_change_of_the_spindles_speed_in_air_for_a_cut) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Scenario scenario = scenario_named("speed_steps", {1.0, 1.0, seed});
        MillforceController controller(scenario.parameters);
        const RunResult run = simulate(scenario, controller, "millforce").result;
        CHECK(run.trace.size() > 500);
        for (const TracePoint& point : run.trace) {
            CHECK(point.state == static_cast<std::uint8_t>(millforce::control::CutState::air));
        }
        STRCMP_EQUAL("none", run.figures.fault.c_str());
    }
}

/// Of the spindle's current; but for the one window in 200 in which its speed steps.
TEST(ClosedLoop, leaves_of_the_current_in_air_no_more_than_noise_through_rapids_and_steps_of_the_speed) {
    constexpr double noise_A = 0.06;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Scenario scenario = scenario_named("speed_steps", {1.0, 1.0, seed});
        MillforceController controller(scenario.parameters);
        const double A_per_N = 5e-4 * static_cast<double>(scenario.parameters.tool.diameter_mm) /
                               static_cast<double>(scenario.parameters.machine.spindle.K_t1_Nm_per_A);
        std::vector<double> left_A;
        for (const TracePoint& point : simulate(scenario, controller, "millforce").result.trace) {
            if (std::isfinite(point.tangential_force_N)) {
                left_A.push_back(A_per_N * std::abs(point.tangential_force_N));
            }
        }
        CHECK(left_A.size() > 5000);
        std::ranges::sort(left_A);
        left_A.resize(left_A.size() - left_A.size() / 200);
        const double squares_A2 = std::inner_product(left_A.begin(), left_A.end(), left_A.begin(), 0.0);
        CHECK(std::sqrt(squares_A2 / static_cast<double>(left_A.size())) < noise_A);
    }
}

/// The passes in both directions, each on a block that is already milled up to it, by a tool file with its own side.
TEST(ClosedLoop, mills_a_zig_zag_no_slower_than_each_of_its_passes_alone) {
    const millforce::test::TemporaryFolder folder;
    const auto cutting_time_of_pass_s = [&](const std::string& from, const std::string& to, double milled_to_mm,
                                            millforce::estimation::CutSide side) {
        Scenario pass = scenario_named("zigzag");
        pass.program_file = folder.write("pass.ngc", "%\nG21 G90 G17 G40 G49 G80 G94\nS4000 M3\nG0 Z5\nG0 " + from +
                                                         "\nG0 Z-6\nG1 " + to + " F1500\nG0 Z5\nM5\nM30\n%\n");
        pass.stock.block.max_y_mm = milled_to_mm;
        pass.parameters.tool.side = side;
        const RunFigures figures = controlled(pass);
        CHECK(bounds_hold(figures));
        return figures.cutting_time_s;
    };
    const double down_s = cutting_time_of_pass_s("X-8 Y2", "X88", 0.0, millforce::estimation::CutSide::down);
    const double up_s = cutting_time_of_pass_s("X88 Y-1", "X-8", -3.0, millforce::estimation::CutSide::up);
    CHECK(controlled(scenario_named("zigzag")).cutting_time_s < 3.0 * (down_s + up_s));
}

/// Its two arcs show the mean forces of one wide and shallow cut, whose teeth would carry much less.
TEST(ClosedLoop, holds_the_limit_where_the_tool_straddles_a_channel) {
    for (const double channel_mm : {4.0, 7.0, 9.0}) {
        for (const Conditions& conditions : {Conditions{1.0, 1.0, 1}, Conditions{1.3, 0.8, 2}}) {
            Scenario scenario = scenario_named("slot_entry", conditions);
            scenario.parameters.tool.control.depth_step_ratio = 2.0F;
            const double half_mm = 0.5 * channel_mm;
            scenario.stock.boxes.push_back({25.0, -half_mm, 60.0, half_mm, -10.0, -10.0});
            const RunFigures figures = controlled(scenario);
            STRCMP_EQUAL("none", figures.fault.c_str());
            CHECK(bounds_hold(figures));
        }
    }
}

TEST(ClosedLoop, saves_time_against_a_safe_constant_feed) {
    CHECK(time_saved("depth_ramp") > 0.40);
    CHECK(time_saved("slot_entry") > 0.0);
    CHECK(time_saved("face_mill_dynamometer") > 0.2);
}

TEST(ClosedLoop, is_saved_by_the_entry_feed_where_no_reaction_is_fast_enough) {
    Scenario careless = scenario_named("slot_entry");
    careless.parameters.tool.control.air_feed_per_tooth_mm = 0.18F;
    careless.parameters.tool.control.entry_feed_per_tooth_mm = 0.18F;
    CHECK(controlled(careless).teeth_broken > 0);
    LONGS_EQUAL(0, controlled(scenario_named("slot_entry")).teeth_broken);
}

TEST(ClosedLoop, breaks_no_tooth_where_the_depth_doubles_without_warning) {
    for (const Conditions& conditions :
         {Conditions{1.0, 1.0, 1}, Conditions{1.3, 0.8, 2}, Conditions{1.3, 1.2, 3}, Conditions{0.7, 1.2, 4}}) {
        Scenario steps = scenario_named("depth_steps", conditions);
        const RunFigures figures = controlled(steps);
        STRCMP_EQUAL("none", figures.fault.c_str());
        LONGS_EQUAL(0, figures.teeth_broken);
        steps.parameters.tool.control.depth_step_ratio = 1.0F;
        CHECK(controlled(steps).peak_over_limit > figures.peak_over_limit + 0.1);
    }
}

TEST(ClosedLoop, is_no_slower_than_the_constant_feed_that_a_program_has_run_at) {
    for (const bool has_axes : {true, false}) {
        Scenario steps = scenario_named("depth_steps");
        if (!has_axes) {
            steps.parameters = millforce::test::without_axis_currents(steps.parameters);
        }
        constexpr float constant_override = 0.15F;
        ConstantFeed constant(steps.parameters, static_cast<double>(constant_override));
        const RunFigures before = simulate(steps, constant, "constant").result.figures;
        const RunFigures unproven = controlled(steps);
        steps.parameters.tool.control.proven_override = constant_override;
        const RunFigures proven = controlled(steps);
        LONGS_EQUAL(0, before.teeth_broken);
        LONGS_EQUAL(0, proven.teeth_broken);
        CHECK(proven.time_s < 1.02 * before.time_s);
        CHECK(proven.time_s < unproven.time_s);
    }
}

TEST(ClosedLoop, mills_a_program_whose_feed_is_safe_faster_than_one_that_has_run_at_it_and_breaks_no_tooth) {
    const auto safe_override = static_cast<float>(safe_constant_override(scenario_named("width_step")));
    for (const double hardness : {0.7, hardest_material}) {
        Scenario step = scenario_named("width_step", {hardness, 1.0, 1});
        step.parameters.tool.control.depth_step_ratio = 2.0F;
        step.parameters.tool.control.proven_override = safe_override;
        const RunFigures proven = controlled(step);
        step.parameters.tool.control.proven_override = 0.0F;
        step.parameters.tool.control.safe_override = safe_override;
        const RunFigures safe = controlled(step);
        LONGS_EQUAL(0, safe.teeth_broken);
        CHECK_COMPARE(safe.time_s, <, 0.9 * proven.time_s);
    }
}

/// Not in an interrupted cut: there both take 14 to 16 s from seed to seed, as a force at a threshold decides.
TEST(ClosedLoop, mills_in_fixed_point_as_in_float) {
    for (const char* name : {"slot_entry", "depth_ramp"}) {
        double rms_in_float = 0.0;
        double rms_in_fixed = 0.0;
        constexpr std::uint64_t seeds = 3;  // one estimate of a cutter that leaves moves the rms of one run
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
            const Scenario scenario = scenario_named(name, {1.0, 1.0, seed});
            FixedPointController controller(scenario.parameters);
            const RunFigures in_fixed = simulate(scenario, controller, "millforce_fixed").result.figures;
            const RunFigures in_float = controlled(scenario);
            CHECK(bounds_hold(in_fixed));
            DOUBLES_EQUAL(in_float.time_s, in_fixed.time_s, 0.02 * in_float.time_s);
            DOUBLES_EQUAL(in_float.peak_over_limit, in_fixed.peak_over_limit, 0.02);
            DOUBLES_EQUAL(in_float.depth_rms_mm, in_fixed.depth_rms_mm, 0.02);
            DOUBLES_EQUAL(in_float.mean_override, in_fixed.mean_override, 0.02 * in_float.mean_override);
            UNSIGNED_LONGS_EQUAL(0, millforce::estimation::saturations());
            rms_in_float += in_float.immersion_rms / seeds;
            rms_in_fixed += in_fixed.immersion_rms / seeds;
        }
        DOUBLES_EQUAL(rms_in_float, rms_in_fixed, 0.005);
    }
}

TEST(ClosedLoop, is_the_same_to_the_bit_for_the_same_seed) {
    const RunFigures first = controlled(scenario_named("interrupted", {1.0, 1.0, 9}));
    const RunFigures second = controlled(scenario_named("interrupted", {1.0, 1.0, 9}));
    CHECK(first.peak_tooth_force_N == second.peak_tooth_force_N);
    CHECK(first.immersion_rms == second.immersion_rms);
    CHECK(first.time_s == second.time_s);
    CHECK(controlled(scenario_named("interrupted", {1.0, 1.0, 10})).immersion_rms != first.immersion_rms);
}

TEST(ClosedLoop, the_cuts_that_calibrations_take_are_milled_to_their_end) {
    for (const char* name : {"standard_cut_x", "standard_cut_y", "unknown_tool", "force_drop_cuts", "air_cuts"}) {
        const RunFigures figures = controlled(scenario_named(std::string("commissioning/") + name));
        STRCMP_EQUAL("none", figures.fault.c_str());
        CHECK(figures.finished);
    }
}

TEST(ClosedLoop, a_tool_that_runs_out_by_more_than_its_file_says_is_driven_by_what_is_measured) {
    Scenario scenario = scenario_named("slot_entry");
    scenario.cutter.runout_mm = 0.016;  // the file: 6 µm between two teeth; here 23 µm
    const RunFigures measured = controlled(scenario);
    CHECK(bounds_hold(measured));
    CHECK_COMPARE(measured.peak_over_limit, >, 0.8);
    // And one that runs true is not held back by what the file says.
    scenario.cutter.runout_mm = 0.0;
    const double true_s = controlled(scenario).time_s;
    scenario.parameters.tool.runout_um = 23.0F;
    const double feared_s = controlled(scenario).time_s;
    CHECK_COMPARE(true_s, <, feared_s);
    CHECK_COMPARE(true_s, <, measured.time_s);
}
