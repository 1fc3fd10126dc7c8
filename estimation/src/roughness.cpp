// SPDX-License-Identifier: Apache-2.0
#include "estimation/surface/roughness.hpp"

namespace millforce::estimation {

template float student_t_975(float);
template Measurement<float> force_ratio(const Measurement<float>&, const Measurement<float>&);
template class RoughnessPredictor<float>;

}  // namespace millforce::estimation
