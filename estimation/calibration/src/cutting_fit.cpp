// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/cutting_fit.hpp"

namespace millforce::estimation {

template struct CuttingFit<float>;
template CuttingFit<float> fit_cutting_law(std::span<const CuttingMeasurement<float>>, const CuttingFitOptions<float>&);

}  // namespace millforce::estimation
