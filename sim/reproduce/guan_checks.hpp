// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/reproduction.hpp"

/// Checks of our own about Guan et al.: formulas of the paper against counting and against the plant, three models of
/// the chip, and the plant against the fine integration of fine_integration.hpp.

namespace millforce::sim::guan_reproduction {

void check_geometry(Reproduction& out);

/// The paper's law of cosines, with the missing "+" and "cos" restored, equals the plant's two circles.
void check_law_of_cosines(Reproduction& out);

/// Section 3.1.1, with its plot.
void check_chip_models(Reproduction& out);

/// The five cases of Fig. 6, and cuts at random.
void check_integration(Reproduction& out);

}  // namespace millforce::sim::guan_reproduction
