// SPDX-License-Identifier: Apache-2.0
// Instantiates the estimators that have no file of their own, so that the core's compiler flags and warnings see them.
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/feed_force_observer.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation/drives/warm_up_tracker.hpp"
#include "estimation/signal/encoder_angle.hpp"

namespace millforce::estimation {

template class WarmUpTracker<float>;
template class EncoderAngle<float>;
template class SpindleDrive<float>;
template class FeedDrive<float>;
template class FeedForceObserver<float>;

}  // namespace millforce::estimation
