// SPDX-License-Identifier: Apache-2.0
#include "preview/clairvoyant.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>

#include "sim/preview/named_scenario.hpp"

using namespace millforce::sim;
using namespace millforce::test;

TEST_GROUP(ClairvoyantFeed){};

TEST(ClairvoyantFeed, brings_the_highest_tooth_to_its_limit_and_hardly_beyond) {
    for (const char* name : {"slot_entry", "width_step", "interrupted", "face_mill"}) {
        for (const double hardness : {0.7, 1.3}) {
            const RunFigures figures = clairvoyant_run(scenario_named(name, hardness)).figures;
            CHECK_TRUE(figures.finished);
            CHECK_COMPARE(figures.peak_over_limit, >, 0.97);
            CHECK_COMPARE(figures.peak_over_limit, <, 1.05);
        }
    }
}

TEST(ClairvoyantFeed, brakes_to_a_wall_with_the_machines_acceleration) {
    const Scenario scenario = scenario_named("slot_entry");
    const ClairvoyantFeed plan(scenario);
    const double acceleration_mm_s2 = static_cast<double>(scenario.parameters.machine.cnc.acceleration_mm_s2);
    const double in_slot_mm_s = plan.feed_at(180.0);
    double braking_mm_s = 0.0;
    for (double path_mm = 142.7; path_mm < 170.0; path_mm += 0.1) {
        const double here = plan.feed_at(path_mm);
        const double next = plan.feed_at(path_mm + 0.1);
        CHECK_COMPARE(here * here - next * next, <=, 2.0 * acceleration_mm_s2 * 0.1 * 1.01);
        braking_mm_s += here > next ? here - next : 0.0;
    }
    CHECK_COMPARE(braking_mm_s, >, in_slot_mm_s);
}

TEST(ClairvoyantFeed, a_lower_limit_is_a_slower_feed) {
    const Scenario scenario = scenario_named("slot_entry");
    CHECK_COMPARE(ClairvoyantFeed(scenario, 0.5).feed_at(180.0), <,
                  0.5 * ClairvoyantFeed(scenario, 1.0).feed_at(180.0));
}

TEST(ClairvoyantFeed, behind_the_programs_end_nothing_is_planned) {
    CHECK_TRUE(std::isinf(ClairvoyantFeed(scenario_named("slot_entry")).feed_at(1e6)));
}
