// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <limits>
#include <numbers>

#include "cutting/engagement_map.hpp"

using namespace millforce::sim;

namespace {

constexpr double bin = EngagementMap::bin_rad;

}  // namespace

TEST_GROUP(EngagementMap){};

TEST(EngagementMap, the_covered_part_of_an_interval_stands_at_its_own_edge) {
    const EngagementMap map = uniform_engagement(10.25 * bin, 20.75 * bin, 3.0);
    const CoveredPart first = covered_part(map, 10);
    DOUBLES_EQUAL(0.25, first.low, 1e-6);
    DOUBLES_EQUAL(1.0, first.high, 0.0);
    const CoveredPart last = covered_part(map, 20);
    DOUBLES_EQUAL(0.0, last.low, 0.0);
    DOUBLES_EQUAL(0.75, last.high, 1e-6);
    DOUBLES_EQUAL(1.0, covered_part(map, 15).weight, 0.0);
}

TEST(EngagementMap, a_lone_sliver_is_spread_over_its_bin) {
    const EngagementMap map = uniform_engagement(10.4 * bin, 10.6 * bin, 3.0);
    const CoveredPart part = covered_part(map, 10);
    DOUBLES_EQUAL(0.2, part.weight, 1e-6);
    DOUBLES_EQUAL(0.0, part.low, 0.0);
    DOUBLES_EQUAL(1.0, part.high, 0.0);
}

TEST(EngagementMap, neighbours_are_found_across_the_turn) {
    EngagementMap map;
    map.bins[719] = {0.0F, 1.0F, 1.0F};
    map.bins[0] = {0.0F, 1.0F, 0.5F};
    DOUBLES_EQUAL(0.5, covered_part(map, 0).high, 0.0);
    map.bins[719].covered = 0.5F;
    map.bins[0].covered = 1.0F;
    DOUBLES_EQUAL(0.5, covered_part(map, 719).low, 0.0);
}

TEST(EngagementMap, a_bin_holds_material_only_if_every_number_says_so) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(holds_material({0.0F, 1.0F, 0.1F}));
    CHECK_FALSE(holds_material({1.0F, 1.0F, 1.0F}));
    CHECK_FALSE(holds_material({0.0F, 1.0F, 0.0F}));
    CHECK_FALSE(holds_material({nan, 1.0F, 1.0F}));
    CHECK_FALSE(holds_material({0.0F, nan, 1.0F}));
    CHECK_FALSE(holds_material({0.0F, 1.0F, nan}));
}
