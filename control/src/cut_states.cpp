// SPDX-License-Identifier: Apache-2.0
#include "control/cut_states_impl.hpp"

namespace millforce::control {

template class CutStates<float>;
template class CutStates<estimation::Fixed>;

}  // namespace millforce::control
