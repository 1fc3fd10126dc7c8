// SPDX-License-Identifier: Apache-2.0
#include "stock/engagement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "../cutting/random_numbers.hpp"
#include "tool_path.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 5.0;
constexpr double cell = 0.1;
constexpr double depth = 2.0;

/// A feed direction with the normal on its left, in which a test is laid out.
struct Frame {
    explicit Frame(double angle_rad) : feed(std::cos(angle_rad), std::sin(angle_rad)), left(-feed.y(), feed.x()) {}

    [[nodiscard]] Eigen::Vector3d at(double along, double beside, double z = -depth) const {
        const Eigen::Vector2d point = feed * along + left * beside;
        return {point.x(), point.y(), z};
    }

    Eigen::Vector2d feed;
    Eigen::Vector2d left;
};

HeightMap block(double half_size_mm = 25.0) {
    return {-half_size_mm, -half_size_mm, half_size_mm, half_size_mm, cell, 0.0};
}

/// Engagement of a cut beside a wall that a first pass of the same cutter left: on the left of the feed (down milling,
/// the tooth leaves at the wall that it makes on the right) or on the right of it (up milling).
struct SideCut {
    double width_mm;
    bool down;

    [[nodiscard]] double entry_rad() const { return down ? pi - std::acos(1.0 - width_mm / radius) : 0.0; }
    [[nodiscard]] double exit_rad() const { return down ? pi : std::acos(1.0 - width_mm / radius); }
};

void check_side_cut(const SideCut& cut, const Frame& frame, double offset_mm, double start_mm) {
    HeightMap map = block(15.0);
    CuttingTool tool(map, end_mill());
    const double first = offset_mm + (cut.down ? 3.0 : -3.0);
    map.remove(end_mill(), frame.at(-12.0 + start_mm, first), frame.at(12.0, first));
    const double second = first + (cut.down ? -cut.width_mm : cut.width_mm);
    tool.place(frame.at(-4.0 + start_mm, second));
    tool.line_to(frame.at(4.0, second), [&](double path_mm, const TrueEngagement& truth) {
        if (path_mm < 1.0) {
            return;
        }
        CHECK(truth.cutting);
        LONGS_EQUAL(1, truth.intervals);
        DOUBLES_EQUAL(cut.width_mm / radius, truth.radial_immersion, 0.01);
        DOUBLES_EQUAL(depth, truth.axial_depth_mm, 0.001 * depth);
        // The wall's place to 0.2 cells, as an angle: R sin φ dφ.
        const double wall_rad = cut.down ? cut.entry_rad() : cut.exit_rad();
        const double tolerance = 0.2 * cell / (radius * std::sin(wall_rad)) + 0.25 * EngagementMap::bin_rad;
        DOUBLES_EQUAL(cut.entry_rad(), truth.entry_rad, cut.down ? tolerance : 1e-9);
        DOUBLES_EQUAL(cut.exit_rad(), truth.exit_rad, cut.down ? 1e-9 : tolerance);
    });
}

}  // namespace

TEST_GROUP(Engagement){};

TEST(Engagement, a_slot_is_engaged_from_zero_to_pi_at_full_depth_in_every_direction) {
    RandomNumbers random(1);
    for (int k = 0; k < 16; ++k) {
        const Frame frame(k < 8 ? k * pi / 4.0 : random.between(0.0, 2.0 * pi));
        HeightMap map = block(15.0);
        CuttingTool tool(map, end_mill());
        const double offset = random.between(-0.1, 0.1);
        tool.place(frame.at(-8.0, offset));
        tool.line_to(frame.at(8.0, offset), [&](double, const TrueEngagement& truth) {
            DOUBLES_EQUAL(2.0, truth.radial_immersion, 1e-4);
            DOUBLES_EQUAL(0.0, truth.entry_rad, 1e-9);
            DOUBLES_EQUAL(pi, truth.exit_rad, 1e-9);
            DOUBLES_EQUAL(depth, truth.axial_depth_mm, 1e-4);
            LONGS_EQUAL(1, truth.intervals);
        });
    }
}

TEST(Engagement, side_cuts_of_any_width_on_both_sides_are_seen_within_one_percent_of_the_radius) {
    RandomNumbers random(2);
    for (const double width : {0.1, 0.5, 1.0, 2.5, 5.0, 8.0, 9.9}) {
        for (const bool down : {true, false}) {
            for (int k = 0; k < 8; ++k) {
                check_side_cut({width, down}, Frame(k * pi / 4.0), random.between(-0.2, 0.2),
                               random.between(-0.1, 0.1));
            }
            for (int k = 0; k < 4; ++k) {
                check_side_cut({width, down}, Frame(random.between(0.0, 2.0 * pi)), random.between(-0.2, 0.2),
                               random.between(-0.1, 0.1));
            }
        }
    }
}

TEST(Engagement, a_clean_wall_beside_the_tool_is_not_taken_for_a_cut) {
    RandomNumbers random(3);
    for (int k = 0; k < 16; ++k) {
        const Frame frame(k < 8 ? k * pi / 4.0 : random.between(0.0, 2.0 * pi));
        HeightMap map = block(15.0);
        CuttingTool tool(map, end_mill());
        const double offset = random.between(-0.1, 0.1);
        tool.place(frame.at(-9.0, offset));
        tool.line_to(frame.at(9.0, offset));
        tool.place(frame.at(-7.0, offset));
        tool.line_to(frame.at(7.0, offset), [](double, const TrueEngagement& truth) {
            CHECK_FALSE(truth.cutting);
            DOUBLES_EQUAL(0.0, truth.radial_immersion, 0.0);
        });
    }
}

TEST(Engagement, widening_a_round_pocket_shows_the_immersion_of_concave_geometry) {
    const double first = 20.0;
    for (const double width : {0.5, 4.0}) {
        HeightMap map = block(32.0);
        CuttingTool tool(map, end_mill());
        tool.place({first, 0.0, -depth});
        tool.arc({0.0, 0.0}, 2.0 * pi);
        const double second = first + width;
        tool.place({second, 0.0, -depth});
        // A point of the periphery at φ is √(R² + ρ² − 2 R ρ cos φ) from the pocket's centre, which lies on the left.
        const double wall = first + radius;
        const double cosine = (radius * radius + second * second - wall * wall) / (2.0 * radius * second);
        tool.arc({0.0, 0.0}, pi, [&](double path_mm, const TrueEngagement& truth) {
            if (path_mm > 2.0 * radius) {
                DOUBLES_EQUAL(1.0 + cosine, truth.radial_immersion, 0.01);
                DOUBLES_EQUAL(depth, truth.axial_depth_mm, 0.001 * depth);
            }
        });
    }
}

TEST(Engagement, head_on_into_a_face_the_engaged_angle_opens_with_the_penetration) {
    RandomNumbers random(4);
    for (int k = 0; k < 8; ++k) {
        HeightMap map = block(30.0);
        const double face = 2.0 + random.between(-0.1, 0.1);
        map.set_box(-30.0, -30.0, face, 30.0, -10.0, -10.0);
        CuttingTool tool(map, end_mill());
        const double y = random.between(-0.1, 0.1);
        tool.place({face - radius - 3.0, y, -depth});
        double deepest = 0.0;
        tool.line_to({face - 0.6 * radius, y, -depth}, [&](double path_mm, const TrueEngagement& truth) {
            const double penetration = path_mm - 3.0;
            if (penetration < -1.3 * cell) {
                CHECK_FALSE(truth.cutting);
                return;
            }
            const double half_angle = 0.5 * (truth.exit_rad - truth.entry_rad);
            const auto opened = [](double d) { return d > 0.0 ? std::acos(1.0 - d / radius) : 0.0; };
            // Seen one cell early in front, up to two further out.
            CHECK(half_angle >= opened(penetration + 0.5 * cell) - EngagementMap::bin_rad);
            CHECK(half_angle <= opened(penetration + 2.0 * cell) + EngagementMap::bin_rad);
            if (truth.cutting) {
                DOUBLES_EQUAL(0.5 * pi, 0.5 * (truth.exit_rad + truth.entry_rad), EngagementMap::bin_rad);
            }
            deepest = std::max(deepest, penetration);
        });
        DOUBLES_EQUAL(0.4 * radius, deepest, 1e-9);
    }
}

TEST(Engagement, in_a_corner_the_immersion_grows_as_the_geometry_says) {
    // Along a wall with a cut of 1.5 mm on the right, into a second wall ahead.
    const double width = 1.5;
    HeightMap map = block(30.0);
    const double wall_y = -3.03;
    const double wall_x = 10.04;
    map.set_box(-30.0, wall_y, wall_x, 30.0, -10.0, -10.0);
    CuttingTool tool(map, end_mill());
    const double y = wall_y - width + radius;
    tool.place({wall_x - radius - 4.0, y, -depth});
    const auto immersion_at = [&](double penetration) {
        const double side = width / radius;  // from cos φ = −1 to −1 + side
        if (penetration <= 0.0) {
            return side;
        }
        const double half_height = std::sin(std::acos(1.0 - penetration / radius));  // the face covers |cos φ| below it
        return half_height >= 1.0 - side ? half_height + 1.0 : side + 2.0 * half_height;
    };
    double largest = 0.0;
    tool.line_to({wall_x - 0.3 * radius, y, -depth}, [&](double path_mm, const TrueEngagement& truth) {
        const double penetration = path_mm - 4.0;
        CHECK(truth.radial_immersion >= immersion_at(penetration) - 0.01);
        if (penetration < 0.4 * radius) {
            CHECK(truth.radial_immersion <= immersion_at(penetration + 2.0 * cell) + 0.01);
        }
        largest = std::max(largest, truth.radial_immersion);
    });
    CHECK(largest > 1.9);
}

TEST(Engagement, islands_are_intervals_of_their_own) {
    HeightMap map(-30.0, -20.0, 30.0, 20.0, cell, -10.0);
    map.set_box(0.0, -3.5, 20.0, -1.0, 0.0, 0.0);
    map.set_box(0.0, 1.0, 20.0, 2.0, 0.0, 0.0);
    CuttingTool tool(map, end_mill());
    tool.place({-10.0, 0.0, -depth});
    tool.line_to({12.0, 0.0, -depth}, [](double path_mm, const TrueEngagement& truth) {
        if (path_mm < 4.8) {
            CHECK_FALSE(truth.cutting);
        } else if (path_mm > 11.0) {
            LONGS_EQUAL(2, truth.intervals);
            DOUBLES_EQUAL(3.5 / radius, truth.radial_immersion, 0.01);
            DOUBLES_EQUAL(std::acos(2.0 / radius), truth.entry_rad, 0.01);
            DOUBLES_EQUAL(std::acos(-3.5 / radius), truth.exit_rad, 0.01);
        }
    });
}

TEST(Engagement, an_interrupted_cut_comes_and_goes_where_the_ribs_are) {
    HeightMap map(-10.0, -20.0, 60.0, 20.0, cell, -10.0);
    for (const double rib : {0.0, 20.0, 40.0}) {
        map.set_box(rib, -20.0, rib + 8.0, 20.0, 0.0, 0.0);
    }
    CuttingTool tool(map, end_mill());
    tool.place({-9.0, 0.0, -depth});
    const auto in_rib = [](double x) {
        return (x > 0.0 && x < 8.0) || (x > 20.0 && x < 28.0) || (x > 40.0 && x < 48.0);
    };
    int cutting = 0;
    tool.line_to({54.0, 0.0, -depth}, [&](double path_mm, const TrueEngagement& truth) {
        const double front = -9.0 + path_mm + radius;
        // The sides leave a rib a radius later than the front.
        if (in_rib(front)) {
            CHECK(truth.cutting);
            ++cutting;
        } else if (!in_rib(front + 1.3 * cell) && !in_rib(front - 0.5 * radius) && !in_rib(front - radius)) {
            CHECK_FALSE(truth.cutting);
        }
    });
    CHECK(cutting > 600);
}

TEST(Engagement, on_a_sloping_top_the_depth_is_the_mean_height_in_front_of_the_tool) {
    HeightMap map(-30.0, -20.0, 30.0, 20.0, cell, 0.0);
    map.set_box(-30.0, -20.0, 30.0, 20.0, 3.0, -3.0);
    CuttingTool tool(map, end_mill());
    tool.place({-10.0, 0.0, -6.0});
    tool.line_to({10.0, 0.0, -6.0}, [&](double path_mm, const TrueEngagement& truth) {
        // Weighted with sin φ, the periphery is π R/4 ahead of the axis.
        const double ahead = -10.0 + path_mm + 0.25 * pi * radius;
        DOUBLES_EQUAL(6.0 - 0.1 * ahead, truth.axial_depth_mm, 0.003 * 6.0);
    });
}

TEST(Engagement, depth_is_counted_up_to_the_flutes_end) {
    Cutter cutter = end_mill();
    cutter.flute_length_mm = 1.25;
    HeightMap map = block(15.0);
    map.remove(cutter, {-5.0, 0.0, -depth}, {0.0, 0.0, -depth});
    DOUBLES_EQUAL(
        1.25,
        summarise(LookAhead(cutter, map.cell_mm()).engagement(map, {0.0, 0.0, -depth}, {1.0, 0.0, 0.0})).axial_depth_mm,
        1e-4);
}

TEST(Engagement, a_plunge_engages_no_flank_and_air_no_tool) {
    const HeightMap map = block(15.0);
    const LookAhead look_ahead(end_mill(), map.cell_mm());
    CHECK_FALSE(summarise(look_ahead.engagement(map, {0.0, 0.0, -depth}, {0.0, 0.0, -1.0})).cutting);
    CHECK_FALSE(summarise(look_ahead.engagement(map, {0.0, 0.0, -depth}, Eigen::Vector3d::Zero())).cutting);
    CHECK_FALSE(summarise(look_ahead.engagement(map, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0})).cutting);
    CHECK_FALSE(summarise(look_ahead.engagement(map, {500.0, 0.0, -depth}, {1.0, 0.0, 0.0})).cutting);
}

TEST(Engagement, a_ball_is_engaged_from_its_tip_to_the_top_in_a_slot) {
    Cutter ball = end_mill();
    ball.type = CutterType::ball_end_mill;
    HeightMap map(-15.0, -10.0, 15.0, 10.0, 0.05, 0.0);
    map.remove(ball, {-10.0, 0.0, -1.0}, {0.0, 0.0, -1.0});
    const EngagementMap engagement = LookAhead(ball, map.cell_mm()).engagement(map, {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0});
    for (std::size_t k = 60; k < 300; ++k) {  // 30° to 150°
        DOUBLES_EQUAL(1.0, engagement.bins[k].top_mm, 0.05);
        CHECK(engagement.bins[k].bottom_mm <= 0.21F);  // one of 24 heights
    }
    for (std::size_t k = 360; k < EngagementMap::bin_count; ++k) {
        CHECK_FALSE(holds_material(engagement.bins[k]));
    }
}

TEST(Engagement, a_ball_beside_its_last_cut_is_engaged_on_the_fresh_side) {
    Cutter ball = end_mill();
    ball.type = CutterType::ball_end_mill;
    HeightMap map(-15.0, -10.0, 15.0, 10.0, 0.05, 0.0);
    map.remove(ball, {-12.0, 0.0, -1.0}, {12.0, 0.0, -1.0});
    map.remove(ball, {-12.0, 1.0, -1.0}, {0.0, 1.0, -1.0});
    const EngagementMap engagement = LookAhead(ball, map.cell_mm()).engagement(map, {0.0, 1.0, -1.0}, {1.0, 0.0, 0.0});
    double left = 0.0;
    double right = 0.0;
    for (std::size_t k = 0; k < 180; ++k) {
        left += holds_material(engagement.bins[k]) ? 1.0 : 0.0;
        right += holds_material(engagement.bins[359 - k]) ? 1.0 : 0.0;
    }
    CHECK(left > 100.0);
    CHECK(right < 0.3 * left);
}
