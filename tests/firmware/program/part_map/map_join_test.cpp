// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_join.hpp"
#include "firmware/tick_bench.hpp"
#include "wrong_maps/wrong_maps.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const EngagedArc slot{0.0, std::numbers::pi, 5.0};

MapPlace place_at(double path_mm, std::vector<EngagedArc> cut = {}) {
    MapPlace place;
    place.path_mm = path_mm;
    place.block_end_mm = 100.0;
    place.line = 5;
    place.programmed_feed_mm_s = 20.0;
    place.spindle_speed_rad_s = 400.0;
    place.cut = std::move(cut);
    return place;
}

/// One block: air to 10 mm, a slot to 60 mm, air to 100 mm.
PartMap one_slot() {
    return {place_at(0.0), place_at(10.0, {slot}), place_at(60.0), place_at(100.0)};
}

/// The slot with another cut from `begin_mm` to `end_mm`.
PartMap slot_with(double begin_mm, double end_mm, const std::vector<EngagedArc>& cut) {
    return {place_at(0.0),  place_at(10.0, {slot}), place_at(begin_mm, cut), place_at(end_mm, {slot}),
            place_at(60.0), place_at(100.0)};
}

EngagedArc as_deep_as(double axial_depth_mm) {
    return {slot.entry_rad, slot.exit_rad, axial_depth_mm};
}

PartMap moved_along(PartMap map, double by_mm) {
    for (MapPlace& place : map) {
        place.path_mm += by_mm;
        place.block_end_mm += by_mm;
    }
    return map;
}

/// A second part of the path, in a block of its own.
PartMap followed_by(PartMap map, const PartMap& next, std::size_t line) {
    const double end_mm = map.back().path_mm;
    map.pop_back();
    for (MapPlace place : moved_along(next, end_mm)) {
        place.line = line;
        map.push_back(place);
    }
    return map;
}

}  // namespace

TEST_GROUP(MapJoin) {
    const Parameters parameters = machine_and_tool();

    JoinedMap join(const PartMap& geometry, const PartMap& run) const {
        return joined(geometry, run, parameters.tool);
    }

    /// The only contradiction, which the map then does not know.
    void contradicts(const JoinedMap& join, const char* what, double begin_mm, double end_mm) const {
        LONGS_EQUAL(1, join.contradictions.size());
        STRCMP_EQUAL(what, join.contradictions.front().what.c_str());
        LONGS_EQUAL(5, join.contradictions.front().line);
        DOUBLES_EQUAL(begin_mm, join.contradictions.front().begin_mm, 0.51);
        DOUBLES_EQUAL(end_mm, join.contradictions.front().end_mm, 0.51);
    }
};

TEST(MapJoin, without_a_run_is_geometry_and_of_no_geometry_is_nothing) {
    const JoinedMap alone = join(one_slot(), {});
    LONGS_EQUAL(4, alone.map.size());
    CHECK(alone.map[1].cut.front() == slot);
    DOUBLES_EQUAL(0.0, alone.compared_mm, 0.0);
    DOUBLES_EQUAL(1.0, alone.hardness, 0.0);
    CHECK(join({}, one_slot()).map.empty());
}

TEST(MapJoin, of_a_run_as_geometry_says_contradicts_nothing_and_keeps_the_depth) {
    const JoinedMap same = join(one_slot(), one_slot());
    CHECK(same.contradictions.empty());
    DOUBLES_EQUAL(47.0, same.compared_mm, 1.0);  // the slot without the margins of its ends
    DOUBLES_EQUAL(1.0, same.hardness, 1e-9);
    DOUBLES_EQUAL(0.01, same.hardness_sd, 1e-9);
    LONGS_EQUAL(1, same.contacts);
    DOUBLES_EQUAL(0.0, same.offset_mm, 1e-9);
    DOUBLES_EQUAL(5.0, same.map[1].cut.front().axial_depth_mm, 1e-9);
}

TEST(MapJoin, takes_what_the_whole_run_is_above_geometry_as_hardness_and_not_as_depth) {
    const JoinedMap harder =
        join(one_slot(), {place_at(0.0), place_at(10.0, {as_deep_as(6.0)}), place_at(60.0), place_at(100.0)});
    DOUBLES_EQUAL(1.2, harder.hardness, 1e-3);
    CHECK(harder.contradictions.empty());
    const MapPlace& in_slot = place_holding_at(harder.map, 30.0);
    DOUBLES_EQUAL(1.2, in_slot.hardness, 1e-3);
    DOUBLES_EQUAL(5.0, in_slot.cut.front().axial_depth_mm, 0.01);
}

TEST(MapJoin, corrects_the_depth_of_a_place_that_deviates_within_its_doubt) {
    PartMap geometry = slot_with(30.0, 40.0, {as_deep_as(5.0)});
    geometry[1].cut.front().axial_depth_mm = geometry[3].cut.front().axial_depth_mm = 4.99;  // places of their own
    const JoinedMap join = this->join(geometry, slot_with(30.0, 40.0, {as_deep_as(5.5)}));
    CHECK(join.contradictions.empty());
    const MapPlace& deeper = place_holding_at(join.map, 35.0);
    CHECK(deeper.cut.front().axial_depth_mm > 5.0);
    CHECK(deeper.cut.front().axial_depth_mm < 5.5);
    CHECK(deeper.axial_depth_sd_mm > 0.0);
}

TEST(MapJoin, does_not_know_a_place_whose_force_is_higher_or_lower_beyond_the_doubt) {
    for (const double depth_mm : {9.0, 2.0}) {
        const JoinedMap join = this->join(slot_with(30.0, 40.0, {slot}), slot_with(30.0, 40.0, {as_deep_as(depth_mm)}));
        contradicts(join,
                    depth_mm > 5.0 ? "the force is higher than by geometry" : "the force is lower than by geometry",
                    30.0, 40.0);
        CHECK(place_holding_at(join.map, 35.0).known == Known::nothing);
        CHECK_TRUE(place_holding_at(join.map, 35.0).is_contested);
        CHECK(place_holding_at(join.map, 20.0).known == Known::cut);
    }
}

TEST(MapJoin, does_not_know_a_place_where_one_of_both_has_air) {
    const JoinedMap air_in_slot = join(one_slot(), slot_with(30.0, 40.0, {}));
    contradicts(air_in_slot, "geometry has a cut, the run air", 30.0, 40.0);
    PartMap with_another_cut = one_slot();
    with_another_cut.insert(with_another_cut.end() - 1, {place_at(70.0, {slot}), place_at(80.0)});
    contradicts(join(one_slot(), with_another_cut), "geometry has air, the run a cut", 70.0, 80.0);
}

TEST(MapJoin, takes_a_contradiction_of_less_than_two_millimetres_for_an_edge) {
    CHECK(join(one_slot(), slot_with(30.0, 31.4, {})).contradictions.empty());
}

/// Half a slot twice as deep takes the same force.
TEST(MapJoin, does_not_know_a_place_whose_arc_differs_though_the_force_agrees) {
    const EngagedArc half{0.5 * std::numbers::pi, std::numbers::pi, 10.0};
    contradicts(join(one_slot(), slot_with(30.0, 40.0, {half})), "the arcs differ", 30.0, 40.0);
    PartMap of_doubt = slot_with(30.0, 40.0, {half});
    of_doubt[2].arc_sd_rad = 0.5;
    CHECK(join(one_slot(), of_doubt).contradictions.empty());
}

TEST(MapJoin, moves_a_blocks_cuts_to_where_the_run_felt_them) {
    const PartMap geometry{place_at(0.0),  place_at(10.0, {slot}), place_at(12.0, {slot}),
                           place_at(60.0), place_at(62.0),         place_at(100.0)};
    const PartMap later{place_at(0.0), place_at(12.0, {slot}), place_at(62.0), place_at(100.0)};
    const JoinedMap join = this->join(geometry, later);
    LONGS_EQUAL(1, join.contacts);
    DOUBLES_EQUAL(2.0, join.offset_mm, 1e-9);
    CHECK(place_holding_at(join.map, 11.0).cut.empty());
    CHECK_FALSE(place_holding_at(join.map, 61.0).cut.empty());
    DOUBLES_EQUAL(0.5, place_holding_at(join.map, 11.0).position_sd_mm, 1e-9);
    CHECK(join.contradictions.empty());
}

TEST(MapJoin, leaves_a_contact_where_geometry_has_it_that_the_run_felt_half_a_millimetre_later) {
    const PartMap later{place_at(0.0), place_at(10.5, {slot}), place_at(60.0), place_at(100.0)};
    const JoinedMap join = this->join(one_slot(), later);
    DOUBLES_EQUAL(0.5, join.offset_mm, 1e-9);
    CHECK_FALSE(place_holding_at(join.map, 10.2).cut.empty());
}

TEST(MapJoin, holds_contacts_further_apart_than_three_millimetres_for_different_ones) {
    const PartMap much_later{place_at(0.0), place_at(14.0, {slot}), place_at(60.0), place_at(100.0)};
    const JoinedMap join = this->join(one_slot(), much_later);
    LONGS_EQUAL(0, join.contacts);
    contradicts(join, "geometry has a cut, the run air", 11.5, 14.0);
}

TEST(MapJoin, matches_blocks_by_line_and_way_to_their_end_wherever_the_run_began) {
    const PartMap geometry = followed_by(one_slot(), one_slot(), 6);
    PartMap second_block = moved_along(one_slot(), -3.0);  // as the CNC first told of it
    second_block.front().path_mm = 0.0;
    for (MapPlace& place : second_block) {
        place.line = 6;
    }
    const JoinedMap join = this->join(geometry, second_block);
    DOUBLES_EQUAL(47.0, join.compared_mm, 1.0);
    LONGS_EQUAL(1, join.contacts);
    DOUBLES_EQUAL(0.0, join.offset_mm, 1e-9);
    CHECK(join.contradictions.empty());
}

TEST(MapJoin, compares_nothing_with_a_block_that_geometry_does_not_have) {
    PartMap other = slot_with(30.0, 40.0, {});
    for (MapPlace& place : other) {
        place.line = 77;
    }
    const JoinedMap of_another_line = join(one_slot(), other);
    DOUBLES_EQUAL(0.0, of_another_line.compared_mm, 0.0);
    CHECK(of_another_line.contradictions.empty());
    DOUBLES_EQUAL(0.0, place_holding_at(of_another_line.map, 30.0).hardness_sd, 0.0);
}

TEST(MapJoin, takes_nothing_from_where_the_run_knew_nothing_or_the_tool_went_in_a_rapid) {
    PartMap unknown = slot_with(30.0, 40.0, {});
    unknown[2].known = Known::nothing;
    CHECK(join(one_slot(), unknown).contradictions.empty());
    PartMap rapid = slot_with(30.0, 40.0, {slot});
    rapid[2].rapid = true;
    CHECK(join(rapid, slot_with(30.0, 40.0, {})).contradictions.empty());
}

/// Of a cut that is known at most, the run may have been in air.
TEST(MapJoin, measures_no_hardness_where_the_run_knew_the_cut_at_most) {
    PartMap at_most = one_slot();
    at_most[1].known = Known::at_most;
    const JoinedMap join = this->join(one_slot(), at_most);
    DOUBLES_EQUAL(0.0, join.compared_mm, 0.0);
    CHECK(join.contradictions.empty());
}

TEST(MapJoin, leaves_out_a_place_of_the_run_that_goes_back_along_the_path) {
    PartMap back = one_slot();
    back.insert(back.begin() + 2, place_at(9.0));
    CHECK(join(one_slot(), back).contradictions.empty());
}
