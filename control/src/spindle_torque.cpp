// SPDX-License-Identifier: Apache-2.0
#include "control/spindle_torque_impl.hpp"

namespace millforce::control {

template class SpindleTorque<float>;
template class SpindleTorque<estimation::Fixed>;

}  // namespace millforce::control
