// SPDX-License-Identifier: Apache-2.0
#include "bench_control/parts.hpp"

#include <map>
#include <set>

#include "bench_control/disturbance.hpp"
#include "bench_control/part_files.hpp"
#include "preview/preview.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>  // after the containers: it replaces `new`

using namespace millforce;
using namespace millforce::sim;

TEST_GROUP(BenchParts) {
    test::TemporaryFolder folder;

    Scenario scenario_of(const BenchPart& part, BenchMachine machine = BenchMachine::currents) {
        write_part_files(folder.path("."), part);
        return read_bench_part(folder.path("."), part, machine);
    }
};

TEST(BenchParts, are_24_in_six_kinds_half_of_each_for_judging_and_no_name_twice) {
    std::map<PartKind, int> of_kind;
    std::map<PartKind, int> judging;
    std::set<std::string_view> names;
    for (const BenchPart& part : bench_parts()) {
        ++of_kind[part.kind];
        judging[part.kind] += part.use == PartUse::judging ? 1 : 0;
        names.insert(part.name);
    }
    LONGS_EQUAL(24, names.size());
    LONGS_EQUAL(6, of_kind.size());
    for (const auto& [kind, count] : of_kind) {
        LONGS_EQUAL(4, count);
        LONGS_EQUAL(2, judging[kind]);
    }
}

/// The map from geometry reads program, blank and tool, and finds the depth that the description states.
TEST(BenchParts, each_is_cut_to_its_stated_depth) {
    for (const BenchPart& part : bench_parts()) {
        double deepest_mm = 0.0;
        double way_in_cut_mm = 0.0;
        for (const host::MapPlace& place : preview(scenario_of(part), 0.5)) {
            for (const host::EngagedArc& arc : place.cut) {
                deepest_mm = std::max(deepest_mm, arc.axial_depth_mm);
            }
            way_in_cut_mm += place.cut.empty() ? 0.0 : 0.5;
        }
        DOUBLES_EQUAL_TEXT(part.depth_mm, deepest_mm, 0.01 * part.depth_mm, std::string(part.name).c_str());
        CHECK_COMPARE(way_in_cut_mm, >, 60.0);
    }
}

TEST(BenchParts, a_plants_blank_is_moved_and_raised_but_what_is_cut_away_stays_so) {
    const Scenario drawn = scenario_of(bench_parts()[8]);  // ribs with gaps
    Disturbance disturbance;
    disturbance.offset_x_mm = 0.5;
    disturbance.offset_y_mm = -1.0;
    disturbance.oversize = 0.1;
    disturbance.cutting_force_scale = 1.2;
    disturbance.override_latency_s = 0.05;
    const Scenario plant = disturbed(drawn, disturbance, 6.0, 3);
    DOUBLES_EQUAL(drawn.stock.block.min_x_mm + 0.5, plant.stock.block.min_x_mm, 1e-9);
    DOUBLES_EQUAL(drawn.stock.block.max_y_mm - 1.0, plant.stock.block.max_y_mm, 1e-9);
    DOUBLES_EQUAL(0.6, plant.stock.block.top_start_mm, 1e-9);
    DOUBLES_EQUAL(drawn.stock.boxes[0].top_start_mm, plant.stock.boxes[0].top_start_mm, 1e-9);
    DOUBLES_EQUAL(1.2, plant.deviation.cutting_force_scale, 1e-9);
    DOUBLES_EQUAL(0.05, static_cast<double>(plant.parameters.machine.cnc.override_latency_s), 1e-6);
}

TEST(BenchParts, disturbances_are_the_same_for_the_same_seed_and_fill_their_ranges) {
    CHECK_TRUE(drawn_disturbance(5).runout_mm == drawn_disturbance(5).runout_mm);
    double lowest = 2.0;
    double highest = 0.0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const Disturbance d = drawn_disturbance(seed);
        lowest = std::min(lowest, d.cutting_force_scale);
        highest = std::max(highest, d.cutting_force_scale);
        CHECK_COMPARE(d.runout_mm, <=, 0.020);
        CHECK_COMPARE(d.override_latency_s, >=, 0.010);
        CHECK_COMPARE(d.oversize, <=, 0.1);
    }
    DOUBLES_EQUAL(0.7, lowest, 0.02);
    DOUBLES_EQUAL(1.3, highest, 0.02);
}

TEST(BenchParts, a_converter_has_a_load_meter_and_no_axis) {
    const Scenario scenario = scenario_of(bench_parts()[4], BenchMachine::converter);
    CHECK_TRUE(scenario.machine.load_meter.is_there());
    DOUBLES_EQUAL(0.0, static_cast<double>(scenario.parameters.machine.axes[0].K_x4_N_per_A), 0.0);
    CHECK_COMPARE(static_cast<double>(scenario.parameters.machine.spindle_load_period_s), >, 0.0);
}
