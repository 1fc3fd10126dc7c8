// SPDX-License-Identifier: Apache-2.0
#include "estimation/surface/roughness_impl.hpp"

namespace millforce::estimation {

template Measurement<float> force_ratio(const Measurement<float>&, const Measurement<float>&);
template Measurement<Fixed> force_ratio(const Measurement<Fixed>&, const Measurement<Fixed>&);
template class RoughnessPredictor<float>;
template class RoughnessPredictor<Fixed>;

}  // namespace millforce::estimation
