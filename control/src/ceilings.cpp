// SPDX-License-Identifier: Apache-2.0
#include "control/ceilings_impl.hpp"

namespace millforce::control {

template class Ceilings<float>;
template class Ceilings<estimation::Fixed>;

}  // namespace millforce::control
