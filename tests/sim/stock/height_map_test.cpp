// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "../cutting/random_numbers.hpp"
#include "files/input_error.hpp"
#include "tool_path.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string refusal_of(double min_x, double max_x, double cell, double top = 0.0) {
    try {
        const HeightMap map(min_x, 0.0, max_x, 10.0, cell, top);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Where on a line from `inside` (air) outwards the share of material passes one half.
double wall_distance(const HeightMap& map, const Eigen::Vector2d& origin, const Eigen::Vector2d& outward, double from,
                     double to) {
    for (double r = from; r < to; r += 0.001) {
        const Eigen::Vector2d point = origin + outward * r;
        if (map.material_above(-1.0, point.x(), point.y()).share >= 0.5F) {
            return r;
        }
    }
    return to;
}

double largest_difference(const HeightMap& one, const HeightMap& other) {
    double largest = 0.0;
    for (std::size_t row = 0; row < one.rows(); ++row) {
        for (std::size_t column = 0; column < one.columns(); ++column) {
            const float difference_mm = one.cell_height_mm(row, column) - other.cell_height_mm(row, column);
            largest = std::max(largest, std::abs(static_cast<double>(difference_mm)));
        }
    }
    return largest;
}

}  // namespace

TEST_GROUP(HeightMap){};

TEST(HeightMap, a_block_has_its_height_inside_and_air_around_it) {
    const HeightMap map(-1.0, -2.0, 3.0, 4.0, 0.1, 7.5);
    LONGS_EQUAL(40, map.columns());
    LONGS_EQUAL(60, map.rows());
    DOUBLES_EQUAL(7.5, map.height_mm(-0.99, -1.99), 0.0);
    DOUBLES_EQUAL(7.5, map.height_mm(2.99, 3.99), 0.0);
    for (const auto& [x, y] : {std::pair{-1.11, 0.0},
                               {3.11, 0.0},
                               {0.0, -2.11},
                               {0.0, 4.11},
                               {1e300, 0.0},
                               {-1e300, 0.0},
                               {not_a_number, 0.0},
                               {0.0, not_a_number}}) {
        CHECK(map.height_mm(x, y) == HeightMap::nothing_mm);
        DOUBLES_EQUAL(0.0, map.material_above(-1000.0, x, y).share, 0.0);
    }
    const HeightMap::Material above = map.material_above(7.0, 1.0, 1.0);
    DOUBLES_EQUAL(1.0, above.share, 1e-6);
    DOUBLES_EQUAL(7.5, above.top_mm, 1e-6);
    DOUBLES_EQUAL(0.0, map.material_above(7.5, 1.0, 1.0).share, 0.0);
}

TEST(HeightMap, empty_endless_and_too_large_blocks_are_refused) {
    STRCMP_EQUAL("", refusal_of(0.0, 10.0, 0.1).c_str());
    STRCMP_CONTAINS("stock: a block of 0 × 10 mm", refusal_of(5.0, 5.0, 0.1).c_str());
    STRCMP_CONTAINS("expected 1 to 64 million in all", refusal_of(5.0, 4.0, 0.1).c_str());
    STRCMP_CONTAINS("expected 1 to 64 million in all", refusal_of(0.0, 1000.0, 0.01).c_str());
    STRCMP_CONTAINS("in cells of 0 mm", refusal_of(0.0, 10.0, 0.0).c_str());
    STRCMP_CONTAINS("in cells of -1 mm", refusal_of(0.0, 10.0, -1.0).c_str());
    CHECK(!refusal_of(0.0, not_a_number, 0.1).empty());
    CHECK(!refusal_of(0.0, std::numeric_limits<double>::infinity(), 0.1).empty());
    CHECK(!refusal_of(0.0, 10.0, not_a_number).empty());
    CHECK(!refusal_of(0.0, 10.0, 0.1, not_a_number).empty());
}

TEST(HeightMap, edges_of_blocks_boxes_and_holes_stand_where_they_are_told) {
    RandomNumbers random(3);
    for (int k = 0; k < 50; ++k) {
        const double edge = random.between(3.0, 4.0);
        const HeightMap block(0.0, 0.0, edge, 4.0, 0.1, 0.0);
        DOUBLES_EQUAL(edge, 6.0 - wall_distance(block, {6.0, 2.0}, {-1.0, 0.0}, 0.0, 5.0), 0.015);
        HeightMap map(-8.0, -8.0, 8.0, 8.0, 0.1, -5.0);
        map.set_box(edge, -4.0, 7.0, 4.0, 0.0, 0.0);  // an island
        DOUBLES_EQUAL(edge, wall_distance(map, {0.0, 0.03}, {1.0, 0.0}, 2.0, 6.0), 0.015);
        HeightMap drilled(-8.0, -8.0, 8.0, 8.0, 0.1, 0.0);
        drilled.set_cylinder(0.03, -0.02, 2.0 * edge, -9.0);
        const double angle = random.between(0.0, 2.0 * pi);
        DOUBLES_EQUAL(edge, wall_distance(drilled, {0.03, -0.02}, {std::cos(angle), std::sin(angle)}, 2.0, 6.0), 0.015);
    }
}

TEST(HeightMap, a_sloping_top_is_a_plane) {
    HeightMap map(0.0, 0.0, 20.0, 5.0, 0.1, 0.0);
    map.set_box(0.0, 0.0, 20.0, 5.0, -1.0, -5.0);
    for (double x = 0.5; x < 19.5; x += 0.333) {
        DOUBLES_EQUAL(-1.0 - 4.0 * x / 20.0, map.material_above(-10.0, x, 2.5).top_mm, 1e-3);
    }
}

TEST(HeightMap, the_walls_of_a_slot_stand_where_they_were_cut_in_any_direction_and_at_any_offset) {
    RandomNumbers random(11);
    const Cutter cutter = end_mill();
    double worst = 0.0;
    double worst_mean = 0.0;
    for (int k = 0; k < 40; ++k) {
        const double angle = k < 8 ? k * pi / 4.0 : random.between(0.0, 2.0 * pi);
        const Eigen::Vector2d feed(std::cos(angle), std::sin(angle));
        const Eigen::Vector2d normal(-feed.y(), feed.x());
        const Eigen::Vector2d centre(random.between(-0.1, 0.1), random.between(-0.1, 0.1));
        HeightMap map(-15.0, -15.0, 15.0, 15.0, 0.1, 0.0);
        CuttingTool tool(map, cutter);
        tool.place({centre.x() - 8.0 * feed.x(), centre.y() - 8.0 * feed.y(), -2.0});
        tool.line_to({centre.x() + 8.0 * feed.x(), centre.y() + 8.0 * feed.y(), -2.0});
        for (const double side : {-1.0, 1.0}) {
            double sum = 0.0;
            int count = 0;
            for (double along = -5.0; along < 5.0; along += 0.037) {
                const double error = wall_distance(map, centre + feed * along, normal * side, 4.5, 5.5) - 5.0;
                worst = std::max(worst, std::abs(error));
                sum += error;
                ++count;
            }
            worst_mean = std::max(worst_mean, std::abs(sum / count));
        }
    }
    CHECK(worst < 0.02);
    CHECK(worst_mean < 0.01);
    CHECK(worst > 0.001);  // a grid has an error; none at all would mean that this test looks at nothing
}

TEST(HeightMap, a_bored_hole_has_its_radius_all_around) {
    const Cutter cutter = end_mill();
    HeightMap map(-20.0, -20.0, 20.0, 20.0, 0.1, 0.0);
    CuttingTool tool(map, cutter);
    tool.place({7.03, 0.01, -2.0});
    tool.arc({0.03, 0.01}, 2.0 * pi);
    for (double angle = 0.0; angle < 2.0 * pi; angle += 0.03) {
        DOUBLES_EQUAL(12.0, wall_distance(map, {0.03, 0.01}, {std::cos(angle), std::sin(angle)}, 11.0, 13.0), 0.02);
    }
    CHECK(map.height_mm(0.0, 0.0) == 0.0F);  // the core between the cuts stands
}

TEST(HeightMap, short_steps_one_long_way_and_a_way_begun_anew_remove_the_same) {
    RandomNumbers random(5);
    const Cutter cutter = end_mill(6.0);
    for (int k = 0; k < 20; ++k) {
        const Eigen::Vector3d from(random.between(-5.0, 5.0), random.between(-5.0, 5.0), -1.0);
        const Eigen::Vector3d to(random.between(-5.0, 5.0), random.between(-5.0, 5.0), -1.0);
        HeightMap one(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
        HeightMap many = one;
        HeightMap anew = one;
        one.remove(cutter, from, to);
        CuttingTool tool(many, cutter);
        tool.place(from);
        tool.line_to(to);
        const Eigen::Vector3d middle = 0.5 * (from + to);
        anew.remove(cutter, middle, to);
        anew.remove(cutter, from, middle);
        for (double x = -9.0; x < 9.0; x += 0.17) {
            for (double y = -9.0; y < 9.0; y += 0.13) {
                const float share = one.material_above(-0.5, x, y).share;
                DOUBLES_EQUAL(share, many.material_above(-0.5, x, y).share, 0.02);
                DOUBLES_EQUAL(share, anew.material_above(-0.5, x, y).share, 0.02);
            }
        }
    }
}

TEST(HeightMap, cutting_the_same_way_again_changes_nothing) {
    const Cutter cutter = end_mill();
    HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
    for (const double z : {-1.0, -3.0}) {
        map.remove(cutter, {-3.0, 0.04, z}, {3.0, 1.0, z});
    }
    const HeightMap before = map;
    for (const double z : {-1.0, -3.0, -1.0}) {
        map.remove(cutter, {-3.0, 0.04, z}, {3.0, 1.0, z});
    }
    DOUBLES_EQUAL(0.0, largest_difference(before, map), 0.0);
}

TEST(HeightMap, a_wall_cut_in_two_levels_stands_where_it_does_at_both) {
    const Cutter cutter = end_mill();
    for (const double offset : {0.0, 0.013, 0.03, 0.05, 0.08}) {
        HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
        map.remove(cutter, {-8.0, offset, -2.0}, {8.0, offset, -2.0});
        map.remove(cutter, {-8.0, offset, -4.0}, {8.0, offset, -4.0});
        for (const double z : {-0.5, -1.5, -2.5, -3.5}) {
            double wall = 4.0;
            while (map.material_above(z, 0.02, wall).share < 0.5F) {
                wall += 0.001;
            }
            DOUBLES_EQUAL(5.0 + offset, wall, 0.015);
        }
    }
}

TEST(HeightMap, facing_lowers_an_edge_and_keeps_its_place) {
    const Cutter cutter = end_mill();
    const Cutter facer = end_mill(40.0);
    HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
    map.remove(cutter, {-8.0, 0.033, -4.0}, {8.0, 0.033, -4.0});
    map.remove(facer, {-40.0, 0.0, -1.0}, {40.0, 0.0, -1.0});
    DOUBLES_EQUAL(-1.0, map.material_above(-2.0, 0.0, 8.0).top_mm, 1e-5);
    double wall = 4.0;
    while (map.material_above(-2.0, 0.02, wall).share < 0.5F) {
        wall += 0.001;
    }
    DOUBLES_EQUAL(5.033, wall, 0.015);
}

TEST(HeightMap, a_ramp_leaves_a_floor_at_or_below_its_own_and_by_less_than_half_a_cell_of_slope) {
    const Cutter cutter = end_mill(4.0);
    HeightMap map(-20.0, -5.0, 20.0, 5.0, 0.1, 0.0);
    map.remove(cutter, {-10.0, 0.0, 0.0}, {10.0, 0.0, -4.0});
    for (double x = -7.5; x < 7.5; x += 0.1) {
        // The flat end passes a point last with its trailing edge, while it sinks: there it is deepest.
        const double floor = -4.0 * (x + 2.0 + 10.0) / 20.0;
        const auto height = static_cast<double>(map.height_mm(x, 0.01));
        CHECK(height <= floor + 0.02 * 0.2 + 0.011);
        CHECK(height >= floor - 0.1 * 0.2 - 0.011);
    }
    HeightMap drilled(-20.0, -5.0, 20.0, 5.0, 0.1, 0.0);
    drilled.remove(cutter, {0.0, 0.0, 5.0}, {0.0, 0.0, -3.0});
    DOUBLES_EQUAL(-3.0, drilled.height_mm(0.0, 0.0), 1e-6);
    DOUBLES_EQUAL(2.0, wall_distance(drilled, {0.0, 0.0}, {1.0, 0.0}, 1.0, 3.0), 0.015);
}

TEST(HeightMap, a_way_that_rises_leaves_what_it_left_deep) {
    const Cutter cutter = end_mill(4.0);
    HeightMap map(-20.0, -5.0, 20.0, 5.0, 0.1, 0.0);
    CuttingTool tool(map, cutter);
    tool.place({-10.0, 0.0, -3.0});
    tool.line_to({0.0, 0.0, -3.0});
    tool.line_to({0.0, 0.0, 5.0});
    tool.line_to({5.0, 0.0, 5.0});
    DOUBLES_EQUAL(-3.0, map.height_mm(0.5, 0.0), 1e-6);
    DOUBLES_EQUAL(0.0, map.height_mm(2.5, 0.0), 0.0);
    tool.line_to({5.0, 0.0, -1.0});
    tool.line_to({7.0, 0.0, 1.0});
    DOUBLES_EQUAL(-1.0, map.height_mm(5.0, 0.0), 1e-6);
}

TEST(HeightMap, a_ball_leaves_the_scallop_of_its_radius) {
    Cutter ball = end_mill(8.0);
    ball.type = CutterType::ball_end_mill;
    HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.05, 0.0);
    CuttingTool tool(map, ball);
    tool.place({-6.0, 0.0, -1.5});
    tool.line_to({6.0, 0.0, -1.5});
    const double half_width = std::sqrt(16.0 - 2.5 * 2.5);
    for (double y = -3.5; y < 3.5; y += 0.07) {
        const double surface = std::abs(y) < half_width ? -1.5 + 4.0 - std::sqrt(16.0 - y * y) : 0.0;
        const double slope = std::abs(y) / std::sqrt(16.0 - y * y);
        DOUBLES_EQUAL(surface, map.height_mm(0.02, y), 0.026 * slope + 1e-3);
    }
}

TEST(HeightMap, ways_in_the_air_outside_or_nowhere_leave_the_block_alone) {
    const Cutter cutter = end_mill();
    HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
    const HeightMap before = map;
    map.remove(cutter, {-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0});
    map.remove(cutter, {-50.0, -16.0, -5.0}, {50.0, -16.0, -5.0});
    map.remove(cutter, {1e9, 1e9, -5.0}, {2e9, 1e9, -5.0});
    map.remove(cutter, {1e308, -1e308, -5.0}, {2e9, 1e308, -5.0});
    map.remove(cutter, {1e12, 1e12, -5.0}, {1e12, 2e12, -9.0});
    map.remove(cutter, {not_a_number, 0.0, -5.0}, {5.0, 0.0, -5.0});
    map.remove(cutter, {0.0, 0.0, -5.0}, {5.0, std::numeric_limits<double>::infinity(), -5.0});
    DOUBLES_EQUAL(0.0, largest_difference(before, map), 0.0);
}

TEST(HeightMap, a_box_set_under_a_standing_tool_is_cut_again) {
    const Cutter cutter = end_mill();
    HeightMap map(-10.0, -10.0, 10.0, 10.0, 0.1, 0.0);
    map.remove(cutter, {0.0, 0.0, -1.0}, {1.0, 0.0, -1.0});
    map.set_box(-10.0, -10.0, 10.0, 10.0, 0.0, 0.0);
    map.remove(cutter, {1.0, 0.0, -1.0}, {1.02, 0.0, -1.0});
    DOUBLES_EQUAL(-1.0, map.height_mm(1.0, 0.0), 1e-6);
}
