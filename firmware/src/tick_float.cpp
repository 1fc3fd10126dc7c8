// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_impl.hpp"

namespace millforce::firmware {

template class ForceControlTick<float>;
template class ForceControlTick<float, NoWideBand<float>>;

}  // namespace millforce::firmware
