// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/friction_fit.hpp"

namespace millforce::estimation {

template struct SymmetricFriction<float>;
template struct DirectionalFriction<float>;
template class MechanicalFrictionFit<float>;
template class FeedCurrentFit<float>;
template float feed_friction_current_A(const Eigen::Matrix<float, 6, 1>&, float);

}  // namespace millforce::estimation
