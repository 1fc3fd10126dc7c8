// SPDX-License-Identifier: Apache-2.0
#include "estimation/cut_estimator_impl.hpp"

namespace millforce::estimation {

template class SynchronousAverage<float, DriveSignals<float>::channels, DriveSignals<float>::velocities>;
template class EngagementSolver<float>;
template class CutEstimator<float>;

}  // namespace millforce::estimation
