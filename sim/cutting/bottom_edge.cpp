// SPDX-License-Identifier: Apache-2.0
#include "cutting/bottom_edge.hpp"

#include <cmath>

#include "cutting/angle_units.hpp"
#include "cutting/checked_value.hpp"

namespace millforce::sim {

void validate(const BottomEdge& edge, double cutter_radius_mm) {
    check_range("bottom_edge.shear_stress_N_mm2", edge.shear_stress_N_mm2, 1e-6, 1e5);
    check_range("bottom_edge.chip_compression", edge.chip_compression, 1.0, 10.0);
    check_range("bottom_edge.friction_angle_rad", edge.friction_angle_rad, 0.0, 60.0 * degree);
    check_range("bottom_edge.rake_rad", edge.rake_rad, -30.0 * degree, 45.0 * degree);
    check_range("bottom_edge.width_mm", edge.width_mm, 1e-6, cutter_radius_mm);
    const double shear_angle_rad = orthogonal_shear_angle_rad(edge.rake_rad, edge.chip_compression);
    check_range("bottom_edge: shear angle + friction angle - rake",
                shear_angle_rad + edge.friction_angle_rad - edge.rake_rad, -89.0 * degree, 89.0 * degree);
}

double orthogonal_shear_angle_rad(double rake_rad, double chip_compression) {
    return std::atan2(1.0, chip_compression / std::cos(rake_rad) - std::tan(rake_rad));
}

double orthogonal_resultant_N(const BottomEdge& edge, double section_mm2) {
    const double shear_angle_rad = orthogonal_shear_angle_rad(edge.rake_rad, edge.chip_compression);
    return edge.shear_stress_N_mm2 * section_mm2 /
           (std::sin(shear_angle_rad) * std::cos(shear_angle_rad + edge.friction_angle_rad - edge.rake_rad));
}

BottomEdgeForce orthogonal_components(const BottomEdge& edge, double resultant_N) {
    const double angle_rad = edge.friction_angle_rad - edge.rake_rad;
    return {.cutting_N = resultant_N * std::cos(angle_rad), .thrust_N = resultant_N * std::sin(angle_rad)};
}

}  // namespace millforce::sim
