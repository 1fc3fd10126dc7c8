// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop/force_drop.hpp"

namespace millforce::estimation {

template class RevolutionProfile<float>;
template class ForceDropDetector<float>;
template class ForceDropImmersion<float>;
template class ForceDrop<float>;

}  // namespace millforce::estimation
