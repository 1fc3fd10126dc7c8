// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_solver.hpp"

/// The core's engagement in double, compiled once (engagement_solver_in_double.cpp): a paper's figures are checked with
/// it, so that no rounding of float stands between them.

namespace millforce::estimation {

extern template class EngagementSolver<double>;

}  // namespace millforce::estimation
