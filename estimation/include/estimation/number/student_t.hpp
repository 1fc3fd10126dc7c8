// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

#include <limits>

/// Two-sided 95 % quantiles, by which a standard error becomes an interval.

namespace millforce::estimation {

/// Of the normal distribution.
template <typename Scalar>
inline constexpr Scalar normal_975 = literal<Scalar>(1.9599640L);

/// Of Student's t. Cornish–Fisher to the fourth order (Abramowitz & Stegun 26.7.5), exact for 1 and 2 degrees of
/// freedom; from 3 on within 0.13 %, from 10 on within 0.002 %. NaN below 1.
template <typename Scalar>
[[nodiscard]] Scalar student_t_975(Scalar degrees_of_freedom) {
    const Scalar nu = degrees_of_freedom;
    if (!(nu >= Scalar(1))) {
        return std::numeric_limits<Scalar>::quiet_NaN();
    }
    if (nu < Scalar(3)) {
        return nu < Scalar(2) ? literal<Scalar>(12.706205L) : literal<Scalar>(4.302653L);
    }
    const Scalar x = Scalar(1) / nu;
    return normal_975<Scalar> + x * (literal<Scalar>(2.3722712L) +
                                     x * (literal<Scalar>(2.8224986L) +
                                          x * (literal<Scalar>(2.5558497L) + x * literal<Scalar>(1.5895341L))));
}

}  // namespace millforce::estimation
