// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cutting/chip_thickness.hpp"
#include "random_numbers.hpp"

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;

EdgePass edge_pass(double radius_mm, double earlier_radius_mm, double advance_mm, double gap_rad) {
    return {radius_mm, earlier_radius_mm, advance_mm / gap_rad, gap_rad};
}

/// Guan et al., section 3.1.1, with the lost "+" and "cos" put back.
double law_of_cosines_mm(double R, double f_z, double theta) {
    const double angle_BOC = std::acos(f_z * std::cos(theta) / R) - theta;
    return R - std::sqrt(R * R + f_z * f_z - 2.0 * R * f_z * std::cos(angle_BOC));
}

/// The path of the earlier edge, point by point, and where it crosses the ray at φ from the present axis: bisection on
/// the side of the ray, without the plant's reduced equation.
double chip_from_path_mm(double radius_mm, double earlier_radius_mm, double advance_mm, double gap_rad, double phi) {
    struct Point {
        double x;
        double y;
    };
    const auto earlier_edge = [&](double angle) {
        const double turned_since_rad = gap_rad + phi - angle;
        return Point{earlier_radius_mm * std::sin(angle) - advance_mm * turned_since_rad / gap_rad,
                     earlier_radius_mm * std::cos(angle)};
    };
    const auto side = [&](double angle) {
        const Point p = earlier_edge(angle);
        return p.x * std::cos(phi) - p.y * std::sin(phi);
    };
    double low = phi - 1.0;
    double high = phi + 1.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (side(middle) < 0.0 ? low : high) = middle;
    }
    const Point p = earlier_edge(0.5 * (low + high));
    return radius_mm - std::hypot(p.x, p.y);
}

double largest_difference_in_feeds(double feed_in_radii, double teeth) {
    const double R = 5.0;
    const double f = feed_in_radii * R;
    double largest = 0.0;
    for (int i = 0; i <= 180; ++i) {
        const double phi = pi * static_cast<double>(i) / 180.0;
        const EdgePass pass = edge_pass(R, R, f, 2.0 * pi / teeth);
        const double difference =
            trochoidal_chip_mm(pass, std::sin(phi), std::cos(phi)) - circular_chip_mm(pass, std::sin(phi));
        largest = std::max(largest, std::abs(difference) / f);
    }
    return largest;
}

}  // namespace

TEST_GROUP(ChipThickness){};

TEST(ChipThickness, offset_circle_is_guans_law_of_cosines) {
    RandomNumbers random(3);
    for (int i = 0; i < 1000; ++i) {
        const double R = random.between(1.0, 40.0);
        const double f_z = random.between(0.001, 0.1) * R;
        const double theta = random.between(0.0, pi);
        const double h = offset_circle_chip_mm(edge_pass(R, R, f_z, 1.0), std::sin(theta), std::cos(theta));
        DOUBLES_EQUAL(law_of_cosines_mm(R, f_z, theta), h, 1e-12 * R);
    }
}

TEST(ChipThickness, trochoid_is_where_the_earlier_path_crosses_the_ray) {
    RandomNumbers random(5);
    for (int i = 0; i < 2000; ++i) {
        const double R = random.between(1.0, 40.0);
        const double earlier = R * random.between(0.98, 1.02);
        const double gap = 2.0 * pi / static_cast<double>(random.whole(1, 12));
        const double f = random.between(0.001, std::min(0.35, 0.24 * gap)) * R;
        const double phi = random.between(0.0, pi);
        const double h = trochoidal_chip_mm(edge_pass(R, earlier, f, gap), std::sin(phi), std::cos(phi));
        DOUBLES_EQUAL(chip_from_path_mm(R, earlier, f, gap, phi), h, 1e-9 * R);
    }
}

TEST(ChipThickness, trochoid_departs_from_the_circle_by_the_first_order_in_feed_over_radius) {
    // (h − f sin φ)/f → (f/R) [½ cos²φ − N/2π sin φ cos φ]; with four teeth at most 0.655 f/R (at φ = 154°).
    DOUBLES_EQUAL(0.655, largest_difference_in_feeds(1e-4, 4.0) / 1e-4, 0.001);
    DOUBLES_EQUAL(0.655, largest_difference_in_feeds(1e-3, 4.0) / 1e-3, 0.002);
    DOUBLES_EQUAL(0.655, largest_difference_in_feeds(0.02, 4.0) / 0.02, 0.02);
    for (const double phi : {0.2, 1.0, 2.0, 3.0}) {
        const EdgePass pass = edge_pass(5.0, 5.0, 5e-4, pi / 2.0);
        const double departure =
            (trochoidal_chip_mm(pass, std::sin(phi), std::cos(phi)) - circular_chip_mm(pass, std::sin(phi))) / 5e-4;
        const double first_order =
            1e-4 * (0.5 * std::cos(phi) * std::cos(phi) - 2.0 / pi * std::sin(phi) * std::cos(phi));
        DOUBLES_EQUAL(first_order, departure, 1e-7);
    }
}

TEST(ChipThickness, runout_of_either_edge_enters_all_three_models) {
    for (const ChipModel model : {ChipModel::circular, ChipModel::offset_circle, ChipModel::trochoidal}) {
        const double phi = pi / 2.0;
        const double even = chip_thickness_mm(model, edge_pass(5.0, 5.0, 0.1, pi / 2.0), std::sin(phi), std::cos(phi));
        const double longer =
            chip_thickness_mm(model, edge_pass(5.01, 5.0, 0.1, pi / 2.0), std::sin(phi), std::cos(phi));
        const double behind =
            chip_thickness_mm(model, edge_pass(5.0, 5.02, 0.1, pi / 2.0), std::sin(phi), std::cos(phi));
        DOUBLES_EQUAL(0.1, even, 1e-9);
        DOUBLES_EQUAL(0.11, longer, 1e-9);
        DOUBLES_EQUAL(0.08, behind, 1e-9);
    }
}

TEST(ChipThickness, a_path_that_never_reached_the_ray_leaves_all_of_the_radius) {
    DOUBLES_EQUAL(0.05, offset_circle_chip_mm(edge_pass(0.05, 0.05, 0.1, pi / 2.0), 0.0, 1.0), 0.0);
    DOUBLES_EQUAL(0.05, trochoidal_chip_mm(edge_pass(0.05, 0.05, 0.1, pi / 2.0), 0.0, 1.0), 0.0);
}
