// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/roughness_in_double.hpp"

#include "estimation/surface/roughness_impl.hpp"

namespace millforce::estimation {

template Measurement<double> force_ratio(const Measurement<double>&, const Measurement<double>&);
template class RoughnessPredictor<double>;

}  // namespace millforce::estimation
