// SPDX-License-Identifier: Apache-2.0
#include "estimation/cut_estimator_impl.hpp"
#include "estimation/number/fixed_point.hpp"

namespace millforce::estimation {

template class CutEstimator<Fixed>;

}  // namespace millforce::estimation
