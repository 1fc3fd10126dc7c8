// SPDX-License-Identifier: Apache-2.0
#include "part_map/part_map.hpp"
#include "firmware/tick_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <utility>

using namespace millforce::host;
using namespace millforce::test;

namespace {

MapPlace air_at(double path_mm) {
    MapPlace place;
    place.path_mm = path_mm;
    place.block_end_mm = 100.0;
    place.programmed_feed_mm_s = 20.0;
    place.spindle_speed_rad_s = 400.0;
    return place;
}

MapPlace cut_at(double path_mm, double axial_depth_mm) {
    MapPlace place = air_at(path_mm);
    place.cut = {{0.0, 1.0, axial_depth_mm}};
    return place;
}

}  // namespace

TEST_GROUP(PartMap) {
    Parameters parameters = machine_and_tool();
};

TEST(PartMap, places_are_the_same_cut_where_feed_speed_and_arcs_are_alike) {
    const MapPlace one = cut_at(1.0, 2.0);
    CHECK(is_same_cut(one, cut_at(5.0, 2.005)));
    CHECK_FALSE(is_same_cut(one, cut_at(1.0, 2.02)));
    CHECK_FALSE(is_same_cut(one, air_at(1.0)));
    MapPlace other = one;
    other.rapid = true;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.programmed_feed_mm_s = 21.0;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.spindle_speed_rad_s = 401.0;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.cut[0].entry_rad = 0.01;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.cut[0].exit_rad = 1.01;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.known = Known::at_most;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.least_share = 0.5;
    CHECK_FALSE(is_same_cut(one, other));
    other = one;
    other.hardness = 1.1;
    CHECK_FALSE(is_same_cut(one, other));
}

TEST(PartMap, of_nothing_has_no_stretch) {
    CHECK(stretches_of({}, parameters).empty());
}

TEST(PartMap, in_air_goes_at_the_highest_override_and_in_a_rapid_as_programmed) {
    MapPlace rapid = air_at(0.0);
    rapid.rapid = true;
    parameters.machine.cnc.override_max = 1.5F;
    const auto stretches = stretches_of({rapid, air_at(10.0), air_at(30.0)}, parameters);
    LONGS_EQUAL(3, stretches.size());
    DOUBLES_EQUAL(20.0, static_cast<double>(stretches[0].feed_mm_s), 1e-4);
    DOUBLES_EQUAL(30.0, static_cast<double>(stretches[1].feed_mm_s), 1e-4);
    DOUBLES_EQUAL(0.0, static_cast<double>(stretches[1].tangential_N), 0.0);
    DOUBLES_EQUAL(30.0, static_cast<double>(stretches[2].begin_mm), 1e-4);  // the program's end
}

TEST(PartMap, has_no_force_where_the_spindle_stands) {
    MapPlace standing = cut_at(0.0, 2.0);
    standing.spindle_speed_rad_s = 0.0;
    const auto stretches = stretches_of({standing}, parameters);
    LONGS_EQUAL(1, stretches.size());
    DOUBLES_EQUAL(0.0, static_cast<double>(stretches[0].tangential_N), 0.0);
}

TEST(PartMap, joins_places_of_one_cut_and_begins_a_stretch_with_another) {
    const auto one = stretches_of({cut_at(0.0, 2.0), cut_at(5.0, 2.0), cut_at(10.0, 2.0)}, parameters);
    LONGS_EQUAL(2, one.size());  // it and its end
    CHECK(one[0].tangential_N > 0.0F);
    const auto two = stretches_of({cut_at(0.0, 2.0), cut_at(5.0, 4.0)}, parameters);
    LONGS_EQUAL(2, two.size());
    CHECK(two[1].feed_mm_s < two[0].feed_mm_s);  // twice as deep
}

TEST(PartMap, of_two_places_at_one_point_of_the_path_keeps_the_first) {
    const auto stretches = stretches_of({cut_at(0.0, 2.0), cut_at(0.0, 4.0), cut_at(9.0, 4.0)}, parameters);
    DOUBLES_EQUAL(0.0, static_cast<double>(stretches[0].begin_mm), 0.0);
    CHECK(stretches.size() < 2 || stretches[1].begin_mm > 0.0F);
    DOUBLES_EQUAL(static_cast<double>(stretches_of({cut_at(0.0, 2.0)}, parameters)[0].tangential_N),
                  static_cast<double>(stretches[0].tangential_N), 1e-3);
}

TEST(PartMap, gives_no_forces_where_nothing_is_known_of_the_cut) {
    MapPlace unknown = cut_at(10.0, 2.0);
    unknown.known = Known::nothing;
    unknown.programmed_feed_mm_s = 0.0;
    const auto stretches = stretches_of({cut_at(0.0, 2.0), unknown, cut_at(20.0, 2.0), air_at(30.0)}, parameters);
    LONGS_EQUAL(4, stretches.size());
    CHECK_TRUE(stretches[0].is_known && stretches[2].is_known);
    CHECK_FALSE(stretches[1].is_known);
    DOUBLES_EQUAL(0.0, static_cast<double>(stretches[1].tangential_N), 0.0);
    CHECK(stretches[1].feed_mm_s > 0.0F);
    DOUBLES_EQUAL(0.0, tooth_force_N(unknown, parameters.tool), 0.0);
}

TEST(PartMap, begins_a_stretch_where_less_of_the_cut_is_sure) {
    MapPlace half = cut_at(10.0, 2.0);
    half.known = Known::at_most;
    half.least_share = 0.5;
    const auto stretches = stretches_of({cut_at(0.0, 2.0), half, air_at(30.0)}, parameters);
    LONGS_EQUAL(3, stretches.size());
    DOUBLES_EQUAL(1.0, static_cast<double>(stretches[0].least_share), 0.0);
    DOUBLES_EQUAL(0.5, static_cast<double>(stretches[1].least_share), 1e-6);
    DOUBLES_EQUAL(static_cast<double>(stretches[0].tangential_N), static_cast<double>(stretches[1].tangential_N), 1e-3);
}

TEST(PartMap, goes_slower_through_a_harder_batch_with_the_same_force_on_a_tooth) {
    MapPlace harder = cut_at(0.0, 6.0);
    const float soft_mm_s = stretches_of({harder}, parameters)[0].feed_mm_s;
    harder.hardness = 1.3;
    CHECK(stretches_of({harder}, parameters)[0].feed_mm_s < 0.9F * soft_mm_s);
}

/// The mean forces may be those of a wider or a narrower cut, whose teeth carry more.
TEST(PartMap, goes_slower_where_the_arc_is_less_sure) {
    for (const auto& [entry_rad, exit_rad] : {std::pair(0.0, 1.0), std::pair(2.1, 3.14)}) {
        MapPlace place = cut_at(0.0, 2.0);
        place.cut = {{entry_rad, exit_rad, 2.0}};
        parameters.tool.tooth_force_limit_N = 250.0F;
        const auto sure = stretches_of({place}, parameters)[0];
        place.arc_sd_rad = 0.3;
        const auto vague = stretches_of({place}, parameters)[0];
        CHECK(vague.feed_mm_s < 0.95F * sure.feed_mm_s);
        CHECK(vague.feed_mm_s > 0.5F * sure.feed_mm_s);
        CHECK(vague.tooth_per_tangential > 1.02F * sure.tooth_per_tangential);
        const float at_sure_feed_N =
            vague.tangential_N * (1.0F - vague.falling_share * (1.0F - sure.feed_mm_s / vague.feed_mm_s));
        DOUBLES_EQUAL(static_cast<double>(sure.tangential_N), static_cast<double>(at_sure_feed_N),
                      0.02 * static_cast<double>(sure.tangential_N));
    }
}

TEST(PartMap, of_any_arc_and_doubt_that_a_file_may_hold_gives_finite_numbers) {
    for (const double width_rad : {1e-5, 0.03, 1.0, 3.1}) {
        for (const double depth_mm : {0.001, 500.0}) {
            for (const double programmed_mm_s : {1e-5, 20.0, 1e4}) {
                MapPlace place = cut_at(0.0, depth_mm);
                place.cut = {{0.02, 0.02 + width_rad, depth_mm}};
                place.programmed_feed_mm_s = programmed_mm_s;
                place.arc_sd_rad = 3.14;
                const auto stretch = stretches_of({place}, parameters)[0];
                CHECK(std::isfinite(stretch.feed_mm_s) && std::isfinite(stretch.tooth_per_tangential));
                CHECK(std::isfinite(stretch.tangential_N) && std::isfinite(stretch.falling_share));
            }
        }
    }
}

TEST(PartMap, of_an_arc_that_is_not_known_at_all_gives_a_feed) {
    MapPlace place = cut_at(0.0, 6.0);
    place.arc_sd_rad = 3.0;
    parameters.tool.flute_length_mm = 12.0F;
    CHECK(stretches_of({place}, parameters)[0].feed_mm_s > 1.0F);
}
