// SPDX-License-Identifier: Apache-2.0
#include "estimation/depth_shape/depth_variation_impl.hpp"
#include "estimation/depth_shape/flute_profile_impl.hpp"

namespace millforce::estimation {

template class FluteProfile<float, 1, 720>;
template class ForceIndexFinder<float, 1, 720>;
template class DepthVariationMethod<float>;
template class DepthVariationMethod<Fixed>;

}  // namespace millforce::estimation
