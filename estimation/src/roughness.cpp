// SPDX-License-Identifier: Apache-2.0
#include "estimation/roughness_fit.hpp"

namespace millforce::estimation {

template float student_t_975(float);
template Measurement<float> force_ratio(const Measurement<float>&, const Measurement<float>&);
template class RoughnessPredictor<float>;
template struct RoughnessFit<float>;
template RoughnessFit<float> fit_roughness(std::span<const RoughnessTest<float>>, unsigned);

}  // namespace millforce::estimation
