// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"
#include "firmware/signal_supervisor_impl.hpp"

namespace millforce::firmware {

template class SignalSupervisor<float>;
template class SignalSupervisor<estimation::Fixed>;

}  // namespace millforce::firmware
