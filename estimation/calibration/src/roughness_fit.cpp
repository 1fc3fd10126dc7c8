// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/roughness_fit.hpp"

namespace millforce::estimation {

template struct RoughnessFit<float>;
template RoughnessFit<float> fit_roughness(std::span<const RoughnessTest<float>>, unsigned);

}  // namespace millforce::estimation
