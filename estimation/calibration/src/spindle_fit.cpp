// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/spindle_fit.hpp"

namespace millforce::estimation {

template struct SpindleFit<float>;
template SpindleFit<float> fit_spindle(std::span<const SpindleSample<float>>, SpindleFitTerms, float);

}  // namespace millforce::estimation
