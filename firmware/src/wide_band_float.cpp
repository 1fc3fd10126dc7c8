// SPDX-License-Identifier: Apache-2.0
#include "firmware/wide_band_monitor_impl.hpp"

namespace millforce::firmware {

template class WideBandMonitor<float>;

}  // namespace millforce::firmware
