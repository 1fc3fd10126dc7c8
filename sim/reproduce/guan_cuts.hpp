// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cutting/angle_units.hpp"
#include "cutting/cutting_force.hpp"
#include "cutting/engagement_map.hpp"
#include "reproduce/fine_integration.hpp"

#include <array>

/// The cuts of Guan et al.'s Fig. 6, for the plant and for the fine integration.

namespace millforce::sim::guan_reproduction {

// Section 4.
inline constexpr int teeth = 4;
inline constexpr double radius_mm = 5.0;
inline constexpr double helix_rad = 55.0 * degree;
inline constexpr double feed_per_tooth_mm = 0.1;

// Section 3.2. The rake is not printed: 5° is what the printed shear angle follows from.
inline constexpr double chip_compression = 1.8;
inline constexpr double rake_rad = 5.0 * degree;
inline constexpr double friction_rad = 19.8 * degree;
inline constexpr double resultant_N = 68.0;

struct Case {
    const char* name;
    double axial_depth_mm;
    double radial_width_mm;
    bool up;
};

/// Fig. 6, curves 1 to 5. 12 mm is more than the cutter is wide: a slot.
inline constexpr std::array<Case, 5> figure_6{{
    {"1: a_p 2.5, a_e 6 mm, up", 2.5, 6.0, true},
    {"2: a_p 1, a_e 12 mm, climb (slot)", 1.0, 12.0, false},
    {"3: a_p 1, a_e 3 mm, up", 1.0, 3.0, true},
    {"4: a_p 1, a_e 2 mm, up", 1.0, 2.0, true},
    {"5: a_p 1, a_e 2 mm, climb", 1.0, 2.0, false},
}};

[[nodiscard]] BottomEdge bottom_edge();
[[nodiscard]] FineCut fine_cut(const Case& cut);

/// The plant of the same cut; with or without the bottom edge.
[[nodiscard]] CuttingForce plant_of(const FineCut& cut, bool with_bottom, ChipModel model = ChipModel::trochoidal);
[[nodiscard]] EngagementMap map_of(const FineCut& cut);

}  // namespace millforce::sim::guan_reproduction
