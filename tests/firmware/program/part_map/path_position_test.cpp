// SPDX-License-Identifier: Apache-2.0
#include "part_map/path_position.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>
#include <optional>

using namespace millforce::host;

namespace {

MapPlace at(double path_mm, double block_end_mm, std::size_t line) {
    MapPlace place;
    place.path_mm = path_mm;
    place.block_end_mm = block_end_mm;
    place.line = line;
    return place;
}

/// Line 7 is a cycle of three moves, and lines 8 and 9 are run through twice.
const PartMap map = {at(0, 10, 3),  at(4, 10, 3),  at(10, 30, 7), at(30, 35, 7), at(35, 55, 7),
                     at(55, 60, 8), at(60, 70, 9), at(70, 75, 8), at(75, 85, 9), at(85, 85, 9)};

/// What is reported for longer than a change of blocks takes.
std::optional<double> settled(PathPosition& position, std::uint32_t line, double to_go_mm) {
    for (int k = 0; k < 49; ++k) {
        (void)position.find(line, to_go_mm);
    }
    return position.find(line, to_go_mm);
}

void check_at(double expected_mm, PathPosition& position, std::uint32_t line, double to_go_mm) {
    const auto found = settled(position, line, to_go_mm);
    CHECK_TRUE(found.has_value());
    DOUBLES_EQUAL(expected_mm, found.value_or(-1.0), 1e-9);
}

}  // namespace

TEST_GROUP(PathPosition){};

TEST(PathPosition, is_the_blocks_end_less_the_distance_to_go) {
    PathPosition position(map);
    check_at(0.0, position, 3, 10.0);
    check_at(5.5, position, 3, 4.5);
    check_at(10.0, position, 3, 0.0);
}

TEST(PathPosition, moves_and_passes_of_one_line_are_told_apart_by_the_way_so_far) {
    PathPosition position(map);
    check_at(12.0, position, 7, 18.0);
    check_at(29.0, position, 7, 1.0);
    check_at(31.0, position, 7, 4.0);
    check_at(36.0, position, 7, 19.0);
    check_at(57.0, position, 8, 3.0);
    check_at(61.0, position, 9, 9.0);
    check_at(71.0, position, 8, 4.0);
    check_at(80.0, position, 9, 5.0);
}

TEST(PathPosition, a_line_that_lies_behind_is_the_program_begun_again) {
    PathPosition position(map);
    check_at(65.0, position, 9, 5.0);
    check_at(2.0, position, 3, 8.0);
}

TEST(PathPosition, a_path_that_was_blended_round_a_corner_is_taken) {
    PathPosition position(map);
    check_at(9.8, position, 3, 0.2);
    check_at(9.6, position, 7, 20.4);
}

TEST(PathPosition, blocks_that_were_joined_bear_the_last_ones_line) {
    PathPosition position(map);
    check_at(10.0, position, 3, 0.0);
    for (double path_mm = 10.0; path_mm < 60.0; path_mm += 0.1) {
        const auto found = position.find(8, 60.0 - path_mm);
        DOUBLES_EQUAL(path_mm, found.value_or(-1.0), 1e-9);
    }
}

TEST(PathPosition, a_line_that_is_ahead_of_its_distance_while_the_cnc_blends_is_no_jump) {
    PathPosition position(map);
    check_at(9.9, position, 3, 0.1);
    for (int k = 0; k < 10; ++k) {
        DOUBLES_EQUAL(9.9, position.find(7, 0.1).value_or(-1.0), 1e-9);
    }
    DOUBLES_EQUAL(9.9, position.find(4, 0.1).value_or(-1.0), 1e-9);
    DOUBLES_EQUAL(10.1, position.find(7, 19.9).value_or(-1.0), 1e-9);
}

TEST(PathPosition, what_the_map_does_not_have_is_not_found) {
    PathPosition position(map);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(settled(position, 0, 1.0).has_value());
    CHECK_FALSE(settled(position, 4, 1.0).has_value());
    CHECK_FALSE(settled(position, 3, 12.0).has_value());
    CHECK_FALSE(settled(position, 3, -1.0).has_value());
    CHECK_FALSE(settled(position, 3, nan).has_value());
    PathPosition nowhere(PartMap{});
    CHECK_FALSE(settled(nowhere, 3, 1.0).has_value());
}
