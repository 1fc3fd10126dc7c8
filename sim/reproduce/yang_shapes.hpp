// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "estimation/depth_shape/cut_category.hpp"
#include "reproduce/force_record.hpp"
#include "reproduce/reproduction.hpp"

/// The twelve force shapes of Yang, DeVor & Kapoor's section 2: one cut of the plant for each, and Figs. 8, 10, 11 and
/// 13–15.

namespace millforce::sim::yang {

/// A cut of one category, by its angles. End mill 1 of the paper, with another number of flutes.
struct FluteShape {
    estimation::CutCategory category{};
    std::size_t flutes = 4;
    double engagement_deg = 0.0;  ///< α_en
    double sweep_deg = 0.0;       ///< α_sw
};

[[nodiscard]] const std::array<FluteShape, 12>& flute_shapes();  ///< by type, then NO, LO, MO, HO
[[nodiscard]] estimation::FluteAngles<double> angles_of(const FluteShape& shape);

/// A flute enters the workpiece at the encoder's zero. No runout.
[[nodiscard]] SteadyCut cut_of(const FluteShape& shape);

/// "III/MO"
[[nodiscard]] std::string name_of(const FluteShape& shape);

/// Whether the flutes' forces, added as numbers, peak where Table 1 has the peak, or their flat top ends there: within
/// 1°.
[[nodiscard]] bool peaks_by_table_1(const FluteShape& shape);

/// Flutes in cut at once in the plant, at most.
[[nodiscard]] int flutes_in_cut_of_plant(const SteadyCut& cut);

/// Figs. 8, 10, 11, 13, 14 and 15.
[[nodiscard]] std::vector<Plot> shape_plots();

}  // namespace millforce::sim::yang
