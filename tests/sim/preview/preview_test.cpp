// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "cnc/cnc.hpp"
#include "loop/simulation.hpp"
#include "sim/converter_load.hpp"
#include "sim/preview/named_scenario.hpp"
#include "sim/without_axis_currents.hpp"
#include "wrong_maps/wrong_maps.hpp"

using namespace millforce::sim;
using namespace millforce::test;
using millforce::host::Known;
using millforce::host::MapPlace;
using millforce::host::PartMap;
using millforce::host::stretches_of;

namespace {

const MapPlace& place_at(const PartMap& map, double path_mm) {
    return *std::ranges::find_if(map, [&](const MapPlace& place) { return place.path_mm >= path_mm; });
}

void check_arc(double entry_rad, double exit_rad, double depth_mm, const MapPlace& place) {
    CHECK_EQUAL(1U, place.cut.size());
    DOUBLES_EQUAL(entry_rad, place.cut.front().entry_rad, 0.03);
    DOUBLES_EQUAL(exit_rad, place.cut.front().exit_rad, 0.03);
    DOUBLES_EQUAL(depth_mm, place.cut.front().axial_depth_mm, 1e-3);
}

struct Run {
    RunFigures figures;
    bool is_refuted = false;
    double hardness = 0.0;
};

Run with_map(const Scenario& scenario, const PartMap& map) {
    MappedController controller(scenario.parameters, map);
    const RunFigures figures = simulate(scenario, controller, "millforce").result.figures;
    return {figures, controller.ahead().is_refuted(), static_cast<double>(controller.ahead().hardness())};
}

RunFigures blind(const Scenario& scenario) {
    MillforceController controller(scenario.parameters);
    return simulate(scenario, controller, "millforce").result.figures;
}

constexpr double pi = std::numbers::pi;
/// From the tool's start over the retract plane to X-8 at depth.
const double approach_mm = 45.0 + std::hypot(72.0, 50.0) + 10.0;

}  // namespace

TEST_GROUP(Preview){};

TEST(Preview, a_slot_is_air_up_to_the_cutters_radius_in_front_of_the_block_and_half_a_turn_within) {
    const PartMap map = preview(scenario_named("slot_entry"));
    const double block_mm = approach_mm + 8.0;
    CHECK_TRUE(place_at(map, block_mm - 5.3).cut.empty());
    CHECK_FALSE(place_at(map, block_mm - 4.8).cut.empty());
    check_arc(0.0, pi, 5.0, place_at(map, block_mm + 30.0));
    CHECK_TRUE(place_at(map, block_mm + 60.3).cut.empty());
}

TEST(Preview, where_the_front_has_left_the_block_its_two_sides_are_two_arcs) {
    const PartMap map = preview(scenario_named("slot_entry"));
    const MapPlace& place = place_at(map, approach_mm + 8.0 + 57.0);  // 3 mm of 5 before the axis
    CHECK_EQUAL(2U, place.cut.size());
    const double half_gap_rad = std::acos(3.0 / 5.0);
    DOUBLES_EQUAL(0.5 * pi - half_gap_rad, place.cut[0].exit_rad, 0.03);
    DOUBLES_EQUAL(0.5 * pi + half_gap_rad, place.cut[1].entry_rad, 0.03);
}

TEST(Preview, a_program_that_goes_both_ways_mills_down_and_up_in_turn) {
    const PartMap map = preview(scenario_named("zigzag"));
    const double narrow_rad = std::acos(1.0 - 0.6);  // 3 mm of a radius of 5 mm
    bool down = false;
    bool up = false;
    for (const MapPlace& place : map) {
        if (place.cut.size() == 1 && std::abs(place.cut[0].exit_rad - place.cut[0].entry_rad - narrow_rad) < 0.03) {
            down = down || place.cut[0].exit_rad > pi - 0.03;
            up = up || place.cut[0].entry_rad < 0.03;
        }
    }
    CHECK_TRUE(down);
    CHECK_TRUE(up);
}

TEST(Preview, rapids_and_feeds_are_the_programs) {
    const PartMap map = preview(scenario_named("slot_entry"));
    CHECK_TRUE(place_at(map, 20.0).rapid);
    const MapPlace& in_feed = place_at(map, approach_mm + 30.0);
    CHECK_FALSE(in_feed.rapid);
    DOUBLES_EQUAL(1500.0 / 60.0, in_feed.programmed_feed_mm_s, 1e-9);
    CHECK_EQUAL(8U, in_feed.line);
}

TEST(Preview, places_are_in_the_order_of_the_path_and_end_with_the_program_in_air) {
    const PartMap map = preview(scenario_named("interrupted"));
    CHECK_TRUE(std::ranges::is_sorted(map, {}, &MapPlace::path_mm));
    CHECK_TRUE(map.back().cut.empty());
}

TEST(Preview, a_blank_that_may_lie_off_is_known_at_most_where_that_matters) {
    const Scenario scenario = scenario_named("slot_entry");
    const PartMap drawn = preview(scenario);
    const PartMap map = preview_within(scenario, 1.0);
    CHECK_EQUAL(drawn.size(), map.size());
    const double block_mm = approach_mm + 8.0;
    // It may begin a millimetre sooner; within, the slot is the slot.
    CHECK_TRUE(place_at(drawn, block_mm - 5.3).cut.empty());
    CHECK_FALSE(place_at(map, block_mm - 5.3).cut.empty());
    CHECK_TRUE(place_at(map, block_mm - 5.3).known == Known::at_most);
    CHECK_TRUE(place_at(map, block_mm - 6.3).cut.empty());
    check_arc(0.0, pi, 5.0, place_at(map, block_mm + 30.0));
    CHECK_TRUE(place_at(map, block_mm + 30.0).known == Known::cut);
    CHECK_TRUE(std::ranges::equal(preview_within(scenario, 0.0), drawn, [](const MapPlace& a, const MapPlace& b) {
        return a.known == b.known && a.cut == b.cut;
    }));
}

/// Passes of 3 mm, by a tool of 10 mm: along the face of a block that may be off by 2 mm, 1 to 5 mm.
TEST(Preview, of_a_pass_along_the_blanks_face_its_narrowest_is_sure) {
    const PartMap map = preview_within(scenario_named("zigzag"), 2.0);
    const auto is_along_face = [](const MapPlace& place) {
        return std::abs(immersion_of(place) - 1.0) < 0.02 && place.known == Known::at_most &&
               std::abs(place.least_share - 0.15) < 0.06;  // 0.2, or a tenth less by rounding
    };
    CHECK_COMPARE(std::ranges::count_if(map, is_along_face), >, 300);
}

TEST(Preview, a_blank_within_its_tolerance_does_not_refute_the_map) {
    for (const char* name : {"slot_entry", "zigzag", "interrupted"}) {
        const Scenario drawn = scenario_named(name);
        const PartMap map = preview_within(drawn, 1.0);
        for (const double y_mm : {-1.0, 1.0}) {
            Scenario scenario = drawn;
            scenario.stock.move_by(0.8, y_mm);
            const Run run = with_map(scenario, map);
            CHECK_FALSE(run.is_refuted);
            CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.05);
            CHECK_COMPARE(run.figures.time_s, <, 1.05 * blind(scenario).time_s);
        }
    }
}

// ---- The map as the controller takes it
// ------------------------------------------------------------------------------

TEST(Preview, a_straight_cut_is_one_stretch_at_whose_feed_the_tooth_meets_its_set_point) {
    const Scenario scenario = scenario_named("slot_entry");
    const auto stretches = stretches_of(preview(scenario), scenario.parameters);
    const double middle_mm = approach_mm + 38.0;
    const auto after = std::ranges::find_if(
        stretches, [&](const auto& stretch) { return static_cast<double>(stretch.begin_mm) > middle_mm; });
    const auto& slot = *(after - 1);
    CHECK_COMPARE(after->begin_mm - slot.begin_mm, >, 30.0F);
    const auto& tool = scenario.parameters.tool;
    // The tooth that stands out by the runout meets it: the mean tooth stays below, by less than in proportion.
    const double feed_per_tooth_mm = static_cast<double>(slot.feed_mm_s) / (4000.0 / 60.0 * 4.0);
    const double runout = 0.001 * static_cast<double>(tool.runout_um) / feed_per_tooth_mm;
    const double target_N = static_cast<double>(tool.control.setpoint_share * tool.tooth_force_limit_N);
    const double mean_tooth_N = static_cast<double>(slot.tangential_N * slot.tooth_per_tangential);
    CHECK_COMPARE(mean_tooth_N, <, target_N);
    CHECK_COMPARE(mean_tooth_N * (1.0 + runout), >, target_N);
}

TEST(Preview, the_feed_in_air_is_the_largest_override_and_a_rapid_is_a_rapid) {
    const Scenario scenario = scenario_named("slot_entry");
    const auto stretches = stretches_of(preview(scenario), scenario.parameters);
    DOUBLES_EQUAL(CncSettings{}.rapid_feed_mm_s, static_cast<double>(stretches.front().feed_mm_s), 1e-3);
    const auto& before_contact = *std::ranges::find_if(
        stretches, [](const auto& stretch) { return static_cast<double>(stretch.begin_mm) > approach_mm - 0.01; });
    DOUBLES_EQUAL(25.0 * static_cast<double>(scenario.parameters.machine.cnc.override_max),
                  static_cast<double>(before_contact.feed_mm_s), 1e-3);
}

TEST(Preview, an_empty_map_has_no_stretches) {
    CHECK_TRUE(stretches_of({}, scenario_named("slot_entry").parameters).empty());
}

// ---- In the loop
// -----------------------------------------------------------------------------------------------------

TEST(Preview, with_the_map_the_limit_holds_in_softer_and_in_harder_material) {
    for (const char* name : {"slot_entry", "width_step", "width_step_up", "interrupted", "depth_ramp", "face_mill"}) {
        const PartMap map = preview(scenario_named(name));
        for (const double hardness : {0.7, 1.0, 1.3}) {
            const Scenario scenario = scenario_named(name, hardness);
            const Run run = with_map(scenario, map);
            CHECK_FALSE(run.is_refuted);
            CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.05);
        }
    }
}

TEST(Preview, with_the_map_the_part_is_done_sooner) {
    for (const char* name : {"slot_entry", "width_step", "width_step_up", "interrupted", "depth_ramp", "face_mill"}) {
        const Scenario scenario = scenario_named(name);
        CHECK_COMPARE(with_map(scenario, preview(scenario)).figures.time_s, <, 0.95 * blind(scenario).time_s);
    }
}

TEST(Preview, a_step_in_width_that_is_known_costs_hardly_more_than_half_of_the_blind_time) {
    const Scenario scenario = scenario_named("width_step");
    CHECK_COMPARE(with_map(scenario, preview(scenario)).figures.time_s, <, 0.6 * blind(scenario).time_s);
}

TEST(Preview, a_machine_whose_spindle_alone_is_measured_is_nearly_as_fast_with_the_map) {
    for (const char* name : {"slot_entry", "width_step", "face_mill"}) {
        const Scenario with_axes = scenario_named(name);
        const PartMap map = preview(with_axes);
        Scenario scenario = with_axes;
        scenario.parameters = millforce::test::without_axis_currents(scenario.parameters);
        const Run run = with_map(scenario, map);
        CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.05);
        // Its tool's runout stays the one of the file: without the axes no arc is measured.
        CHECK_COMPARE(run.figures.time_s, <, 1.05 * with_map(with_axes, map).figures.time_s);
        CHECK_COMPARE(run.figures.time_s, <, 0.6 * blind(scenario).time_s);
    }
}

TEST(Preview, a_converters_load_that_comes_seldom_and_late_holds_the_limit_with_the_map) {
    double time_s = 0.0;
    double time_with_currents_s = 0.0;
    for (const char* name : {"slot_entry", "width_step"}) {
        for (const double K_s_scale : {1.0, 1.3}) {
            Scenario with_currents = scenario_named(name, K_s_scale);
            const PartMap map = preview(with_currents);
            const Scenario scenario = millforce::test::with_converter_load(with_currents, 0.1, 0.1);
            const Run run = with_map(scenario, map);
            CHECK_FALSE(run.is_refuted);
            CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.05);
            CHECK_COMPARE(run.figures.time_s, <, 0.95 * blind(scenario).time_s);
            if (K_s_scale == 1.0) {
                time_s += run.figures.time_s;
                time_with_currents_s += with_map(with_currents, map).figures.time_s;
            }
        }
    }
    CHECK_COMPARE(time_s, <, 1.25 * time_with_currents_s);
}

TEST(Preview, a_tool_that_is_a_third_of_a_millimetre_off_is_still_on_the_maps_path) {
    for (const char* name : {"slot_entry", "width_step", "interrupted"}) {
        const Scenario scenario = scenario_named(name);
        const PartMap map = preview(scenario);
        for (const double shift_mm : {-0.3, 0.3}) {
            const Run run = with_map(scenario, shifted(map, shift_mm));
            CHECK_FALSE(run.is_refuted);
            CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.05);
        }
    }
}

TEST(Preview, no_wrong_map_breaks_a_tooth_or_costs_more_than_a_sixth_of_the_blind_time) {
    for (const char* name : {"slot_entry", "width_step", "width_step_up", "interrupted"}) {
        const Scenario scenario = scenario_named(name);
        const PartMap map = preview(scenario);
        const double blind_s = blind(scenario).time_s;
        const PartMap of_another_part = preview(scenario_named("zigzag"));
        for (const PartMap& wrong :
             {shifted(map, 0.8), shifted(map, -0.8), shifted(map, 1.5), shifted(map, -1.2), shifted(map, 2.0),
              shifted(map, -2.0), shifted(map, 3.0), shifted(map, 8.0), shifted(map, -20.0), mirrored(map),
              deeper(map, 0.5), deeper(map, 2.0), with_air_behind(map, 0.5), of_another_part}) {
            const Run run = with_map(scenario, wrong);
            CHECK_EQUAL(0, run.figures.teeth_broken);
            CHECK_COMPARE(run.figures.peak_over_limit, <=, 1.1);
            CHECK_COMPARE(run.figures.time_s, <=, 7.0 / 6.0 * blind_s);
        }
    }
}

TEST(Preview, an_empty_map_changes_nothing) {
    const Scenario scenario = scenario_named("slot_entry");
    DOUBLES_EQUAL(blind(scenario).time_s, with_map(scenario, {}).figures.time_s, 1e-9);
}
