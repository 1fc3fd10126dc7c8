// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/least_squares.hpp"

namespace millforce::estimation {

template class LeastSquares<float, 3>;
template class LeastSquares<float, 4>;
template class LeastSquares<float, 5>;
template class LeastSquares<float, 6>;

}  // namespace millforce::estimation
