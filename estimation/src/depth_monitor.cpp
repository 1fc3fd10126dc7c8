// SPDX-License-Identifier: Apache-2.0
#include "estimation/depth_shape/depth_monitor_impl.hpp"

namespace millforce::estimation {

template class FluteProfile<float>;
template class FluteProfile<Fixed>;
template class FluteProfileFit<float>;
template class FluteProfileFit<Fixed>;
template class DepthMonitor<float>;
template class DepthMonitor<Fixed>;

}  // namespace millforce::estimation
