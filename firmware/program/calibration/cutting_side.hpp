// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "estimation_calibration/cutting_fit.hpp"

#include <functional>
#include <ostream>
#include <string>
#include <vector>

/// On which side the cuts were made, by their forces. The torque is the same on both. The force in the plane fits the
/// wrong side badly, or only with an edge that pulls the workpiece (r_1 < 0), which no edge does. The same test finds a
/// force whose sign is opposite to the convention.

namespace millforce::host {

/// The scatter of the forces about the law beyond which a fit says nothing, relative.
inline constexpr double largest_scatter = 0.3;

/// A fit of the cuts on one side.
using FitOnSide = std::function<estimation::CuttingFit(const std::vector<CutRow>&, estimation::CutSide)>;

/// How far the forces in the plane scatter about the fit, without the odd ones.
double plane_scatter(const estimation::CuttingFit& fit);

/// For messages: the file, and what the cuts lack where no side can be fitted at all.
struct CutsInWords {
    std::string file;
    std::string lack;
};

/// The side that fits, or `asked` if it fits. One line on `out` says why, and another one warns where the
/// opposite sign of a force fits as well, as it may at a single width. Throws InputError where neither does, where
/// both do, where the other side or the opposite sign of a force fits far better.
estimation::CutSide side_that_fits(const CutsInWords& words, const std::vector<CutRow>& cuts, estimation::CutSide asked,
                                   const FitOnSide& fit, std::ostream& out);

}  // namespace millforce::host
