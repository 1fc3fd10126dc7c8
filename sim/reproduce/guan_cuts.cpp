// SPDX-License-Identifier: Apache-2.0
#include "reproduce/guan_cuts.hpp"

#include "cutting/oblique_cutting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::sim::guan_reproduction {
namespace {

// Not printed, and the scale of all curves: shear stress of die steel of 42 HRC.
constexpr double assumed_shear_stress_N_mm2 = 800.0;

double swept_rad(double radial_width_mm) {
    return std::acos(std::max(-1.0, 1.0 - radial_width_mm / radius_mm));
}

}  // namespace

BottomEdge bottom_edge() {
    BottomEdge edge{.shear_stress_N_mm2 = assumed_shear_stress_N_mm2,
                    .chip_compression = chip_compression,
                    .friction_angle_rad = friction_rad,
                    .rake_rad = rake_rad,
                    .width_mm = 1.0};
    // As wide as gives the printed resultant at the thickest chip, h = f_z.
    edge.width_mm = resultant_N / orthogonal_resultant_N(edge, feed_per_tooth_mm);
    return edge;
}

FineCut fine_cut(const Case& cut) {
    const double sweep = swept_rad(cut.radial_width_mm);
    const BottomEdge bottom = bottom_edge();
    const ShearedEdge edge{assumed_shear_stress_N_mm2, fine_shear_angle_rad(rake_rad, chip_compression), friction_rad,
                           rake_rad};
    return {teeth,
            radius_mm,
            helix_rad,
            cut.axial_depth_mm,
            feed_per_tooth_mm,
            cut.up ? 0.0 : std::numbers::pi - sweep,
            cut.up ? sweep : std::numbers::pi,
            edge,
            edge,
            bottom.width_mm};
}

CuttingForce plant_of(const FineCut& cut, bool with_bottom, ChipModel model) {
    Cutter cutter;
    cutter.teeth = static_cast<std::size_t>(cut.teeth);
    cutter.diameter_mm = 2.0 * cut.radius_mm;
    cutter.flute_length_mm = std::max(cut.axial_depth_mm, 1.0);
    cutter.helix_rad = cut.helix_rad;
    const ObliqueCut oblique{.shear_stress_N_mm2 = cut.flank.shear_stress_N_mm2,
                             .shear_angle_rad = cut.flank.shear_angle_rad,
                             .friction_angle_rad = cut.flank.friction_angle_rad,
                             .rake_rad = cut.flank.rake_rad,
                             .inclination_rad = cut.helix_rad};
    CuttingForceOptions options{.chip_model = model};
    if (with_bottom) {
        BottomEdge bottom = bottom_edge();
        bottom.width_mm = cut.bottom_width_mm;
        options.bottom_edge = bottom;
    }
    return CuttingForce(cutter, oblique_cutting(oblique), options);
}

EngagementMap map_of(const FineCut& cut) {
    return uniform_engagement(cut.entry_rad, cut.exit_rad, cut.axial_depth_mm);
}

}  // namespace millforce::sim::guan_reproduction
