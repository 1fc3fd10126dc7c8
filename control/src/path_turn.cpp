// SPDX-License-Identifier: Apache-2.0
#include "control/path_turn_impl.hpp"

namespace millforce::control {

template class PathTurn<float>;
template class PathTurn<estimation::Fixed>;

}  // namespace millforce::control
