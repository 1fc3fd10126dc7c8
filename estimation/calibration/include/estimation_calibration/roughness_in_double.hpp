// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/surface/roughness.hpp"

/// The core's roughness prediction in double, compiled once (roughness_in_double.cpp) for calibration and papers.

namespace millforce::estimation {

extern template Measurement<double> force_ratio(const Measurement<double>&, const Measurement<double>&);
extern template class RoughnessPredictor<double>;

}  // namespace millforce::estimation
