// SPDX-License-Identifier: Apache-2.0
// Depth-of-cut estimators from force profiles, instantiated for float.
#include "estimation/depth_shape/depth_variation.hpp"
#include "estimation/depth_shape/depth_monitor.hpp"

namespace millforce::estimation {

template class FluteProfile<float, 1, 720>;
template class FluteProfile<float, 2, 180>;
template class ForceIndexFinder<float, 1, 720>;
template class DepthVariationMethod<float>;
template class FluteProfileFit<float, 10>;
template class DepthMonitor<float>;

}  // namespace millforce::estimation
