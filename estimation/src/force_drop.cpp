// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop/force_drop_impl.hpp"

namespace millforce::estimation {

template class RevolutionProfile<float>;
template class ForceDropDetector<float>;
template class ForceDropDetector<Fixed>;
template class ForceDropImmersion<float>;
template class ForceDropImmersion<Fixed>;
template class ForceDrop<float>;
template class ForceDrop<Fixed>;

}  // namespace millforce::estimation
