// SPDX-License-Identifier: Apache-2.0
// Instantiates every estimator for float, so that the core's compiler flags and warnings see all of it.
#include "estimation/cut_estimator.hpp"
#include "estimation/cutting/peak_factors.hpp"
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/feed_force_observer.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation/drives/warm_up_tracker.hpp"
#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/signal/encoder_angle.hpp"
#include "estimation/signal/synchronous_average.hpp"

namespace millforce::estimation {

template class WarmUpTracker<float>;
template class EncoderAngle<float>;
template class SynchronousAverage<float, 7>;
template class SynchronousAverage<float, 7, 4>;
template class SpindleDrive<float>;
template class FeedDrive<float>;
template class FeedForceObserver<float>;
template class EngagementSolver<float>;
template class ToothPeakTable<float>;
template class CutEstimator<float>;

}  // namespace millforce::estimation
