// SPDX-License-Identifier: Apache-2.0
#include "least_squares_in_double.hpp"

namespace millforce::estimation {

template class LeastSquares<double, 1>;
template class LeastSquares<double, 2>;
template class LeastSquares<double, 3>;
template class LeastSquares<double, 4>;
template class LeastSquares<double, 5>;
template class LeastSquares<double, 6>;

}  // namespace millforce::estimation
