// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"
#include "firmware/wide_band_monitor_impl.hpp"

namespace millforce::firmware {

template class WideBandMonitor<estimation::Fixed>;

}  // namespace millforce::firmware
