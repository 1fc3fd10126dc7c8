// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/engagement_solver_in_double.hpp"

#include "estimation/engagement/engagement_solver_impl.hpp"

namespace millforce::estimation {

template class EngagementSolver<double>;

}  // namespace millforce::estimation
