// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

/// The core's least squares in double, compiled once (least_squares_in_double.cpp) for all fits.

namespace millforce::estimation {

extern template class LeastSquares<double, 1>;
extern template class LeastSquares<double, 2>;
extern template class LeastSquares<double, 3>;
extern template class LeastSquares<double, 4>;
extern template class LeastSquares<double, 5>;
extern template class LeastSquares<double, 6>;

}  // namespace millforce::estimation
