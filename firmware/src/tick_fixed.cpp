// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"
#include "firmware/tick_impl.hpp"

namespace millforce::firmware {

template class ForceControlTick<estimation::Fixed>;
template class ForceControlTick<estimation::Fixed, NoWideBand<estimation::Fixed>>;

}  // namespace millforce::firmware
