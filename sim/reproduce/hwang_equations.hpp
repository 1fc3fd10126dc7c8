// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "estimation_calibration/force_drop_calibration.hpp"
#include "reproduce/reproduction.hpp"

/// Eqs. 5, 6 and 10–14 of Hwang et al., and the paper's iteration: what its Figs. 1–3 draw. The estimators do without
/// the iteration and without its convergence: they bracket the root.

namespace millforce::sim {

/// Fig. 3's claim, that the slope of Eq. 14 is everywhere above that of Eq. 13; the derivatives against difference
/// quotients; the iteration with the paper's a.
void add_convergence(Reproduction& out);

/// Figs. 1–3, with the known cuts of the bench beside the curves of Figs. 1 and 2.
void add_equation_plots(const std::vector<estimation::ForceDropCalibrationCut>& known_cuts, Reproduction& out);

}  // namespace millforce::sim
