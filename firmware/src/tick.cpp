// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"

#include "estimation/number/fixed_point.hpp"
#include "firmware/parameter_table.hpp"

namespace millforce::firmware {

template class ForceControlTick<float>;
template class ForceControlTick<estimation::Fixed>;

}  // namespace millforce::firmware
