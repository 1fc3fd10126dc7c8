// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop.hpp"

#include "estimation/force_drop_calibration.hpp"

namespace millforce::estimation {

template class RevolutionProfile<float>;
template class ForceDropDetector<float>;
template class ForceDropImmersion<float>;
template class ForceDrop<float>;
template class ForceDropCalibration<float>;

}  // namespace millforce::estimation
