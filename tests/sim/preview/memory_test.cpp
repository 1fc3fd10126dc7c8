// SPDX-License-Identifier: Apache-2.0
#include "preview/memory.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "loop/simulation.hpp"
#include "part_map/map_join.hpp"
#include "preview/preview.hpp"
#include "sim/preview/named_scenario.hpp"
#include "wrong_maps/wrong_maps.hpp"

using namespace millforce::sim;
using namespace millforce::test;
using millforce::host::joined;
using millforce::host::JoinedMap;
using millforce::host::Known;
using millforce::host::MapPlace;
using millforce::host::PartMap;

namespace {

/// The block of a slot begins 8 mm behind the point where the tool starts its cut.
double contact_of(const PartMap& map) {
    return std::ranges::find_if(map, [](const MapPlace& place) { return !place.cut.empty(); })->path_mm;
}

}  // namespace

TEST_GROUP(Memory){};

TEST(Memory, a_run_remembers_arc_and_depth_where_they_were) {
    const Scenario scenario = scenario_named("width_step");
    const PartMap truth = preview(scenario);
    const PartMap memory = memory_of(scenario);
    DOUBLES_EQUAL(contact_of(truth), contact_of(memory), 1.0);
    for (const double behind_contact_mm : {20.0, 60.0}) {  // the narrow and the wide part
        const MapPlace& was = place_holding_at(truth, contact_of(truth) + behind_contact_mm);
        const MapPlace& seen = place_holding_at(memory, contact_of(truth) + behind_contact_mm);
        CHECK_TRUE(seen.known == Known::cut);
        CHECK_EQUAL(1U, seen.cut.size());
        DOUBLES_EQUAL(was.cut.front().entry_rad, seen.cut.front().entry_rad, 0.15);
        DOUBLES_EQUAL(was.cut.front().exit_rad, seen.cut.front().exit_rad, 0.01);
        DOUBLES_EQUAL(was.cut.front().axial_depth_mm, seen.cut.front().axial_depth_mm,
                      3.0 * seen.axial_depth_sd_mm + 0.1);
        CHECK_COMPARE(seen.arc_sd_rad, >, 0.0);
    }
}

/// Whose arcs blend into each other: the next one is told before the last one has ended.
TEST(Memory, of_a_round_pocket_goes_along_its_path_and_never_back) {
    const PartMap memory = memory_of(scenario_named("circular"));
    CHECK_COMPARE(memory.size(), >, std::size_t{100});
    CHECK_TRUE(std::ranges::is_sorted(memory, std::ranges::less_equal{}, &MapPlace::path_mm));
}

TEST(Memory, a_second_part_is_done_sooner_and_keeps_the_limit_in_any_batch) {
    for (const char* name : {"width_step", "interrupted"}) {
        const Scenario scenario = scenario_named(name);
        const LearntPart first = mill_and_learn(scenario);
        for (const double hardness : {0.7, 1.0, 1.3}) {
            const LearntPart second = mill_and_learn(scenario_named(name, hardness), first.map);
            CHECK_FALSE(second.is_refuted);
            CHECK_COMPARE(second.figures.peak_over_limit, <=, 1.05);
            if (hardness == 1.0) {
                CHECK_COMPARE(second.figures.time_s, <, 0.9 * first.figures.time_s);
            }
        }
    }
}

TEST(Memory, without_currents_of_the_axes_holds_air_alone_and_says_so) {
    Scenario alone = scenario_named("slot_entry");
    for (auto& axis : alone.parameters.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    const PartMap memory = memory_of(alone);
    CHECK_TRUE(std::ranges::all_of(memory, [](const MapPlace& place) { return place.cut.empty(); }));
    CHECK_TRUE(place_holding_at(memory, contact_of(preview(alone)) + 20.0).known == Known::nothing);
    STRCMP_CONTAINS(" mm of it not known; it holds air alone: without currents of the axes",
                    millforce::host::about_memory(memory).c_str());
    const std::string of_all_currents = millforce::host::about_memory(memory_of(scenario_named("slot_entry")));
    STRCMP_CONTAINS(" mm of path learnt", of_all_currents.c_str());
    CHECK_TRUE(of_all_currents.find("air alone") == std::string::npos);
}

TEST(Memory, of_a_run_that_was_aborted_ends_where_it_ended) {
    const Scenario scenario = scenario_named("slot_entry");
    millforce::host::MapLearner learner(scenario.parameters);
    MappedController controller(scenario.parameters, {}, &learner);
    SimulationSettings settings;
    settings.longest_run_s = 4.0;
    CHECK_FALSE(simulate(scenario, controller, "millforce", settings).result.figures.finished);
    const PartMap map = learner.map();
    const double whole_mm = preview(scenario).back().path_mm;
    CHECK_COMPARE(map.back().path_mm, <, 0.95 * whole_mm);
    CHECK_TRUE(map.back().cut.empty());
    const LearntPart second = mill_and_learn(scenario, map);
    CHECK_TRUE(second.figures.finished);
    CHECK_EQUAL(0, second.figures.teeth_broken);
}

TEST(Memory, joined_with_geometry_it_corrects_the_depth_of_a_harder_steel_as_hardness) {
    const Scenario harder = scenario_named("width_step", 1.2);
    const JoinedMap join = joined(preview(harder), memory_of(harder), harder.parameters.tool);
    DOUBLES_EQUAL(1.2, join.hardness, 0.1);
    CHECK_COMPARE(join.compared_mm, >, 50.0);
    CHECK_COMPARE(std::abs(join.offset_mm), <, 0.75);
    CHECK_TRUE(join.contradictions.empty());
}

TEST(Memory, joined_with_the_geometry_of_a_deeper_block_names_where_they_contradict_each_other) {
    const Scenario scenario = scenario_named("width_step");
    PartMap geometry = preview(scenario);
    const double half_mm = contact_of(geometry) + 0.5 * (geometry.back().path_mm - contact_of(geometry));
    for (MapPlace& place : geometry) {
        if (place.path_mm > half_mm && !place.cut.empty()) {
            place.cut.front().axial_depth_mm *= 2.0;
        }
    }
    const JoinedMap join = joined(geometry, memory_of(scenario), scenario.parameters.tool);
    CHECK_FALSE(join.contradictions.empty());
    CHECK_COMPARE(join.contradictions.front().begin_mm, >=, half_mm - 2.0);
    CHECK_TRUE(place_holding_at(join.map, join.contradictions.front().begin_mm + 1.0).is_contested);
    CHECK_TRUE(place_holding_at(join.map, join.contradictions.front().begin_mm + 1.0).known == Known::nothing);
}

/// A seeded share of a campaign over more parts and shifts.
TEST(Memory, no_wrong_map_from_memory_or_joined_breaks_a_tooth) {
    std::mt19937 random(20);
    const PartMap of_another_part = memory_of(scenario_named("slot_entry"));
    const Scenario scenario = scenario_named("width_step");
    const PartMap memory = memory_of(scenario);
    for (const PartMap& map : {memory, joined(preview(scenario), memory, scenario.parameters.tool).map}) {
        const double by_mm = std::uniform_real_distribution<double>(-20.0, 20.0)(random);
        for (const PartMap& wrong : {shifted(map, by_mm), shifted(map, 0.1 * by_mm), mirrored(map),
                                     with_air_behind(map, 0.5), deeper(map, 0.5), of_another_part}) {
            const LearntPart part = mill_and_learn(scenario, wrong);
            CHECK_EQUAL(0, part.figures.teeth_broken);
            CHECK_COMPARE(part.figures.peak_over_limit, <=, 1.2);
        }
    }
}
