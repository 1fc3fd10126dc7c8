// SPDX-License-Identifier: Apache-2.0
#include "control/cut_trend_impl.hpp"

namespace millforce::control {

template class CutTrend<float>;
template class CutTrend<estimation::Fixed>;

}  // namespace millforce::control
