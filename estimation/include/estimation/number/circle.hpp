// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

namespace millforce::estimation {

template <typename Scalar>
inline constexpr Scalar pi = literal<Scalar>(3.14159265358979323846L);
template <typename Scalar>
inline constexpr Scalar turn_rad = literal<Scalar>(6.28318530717958647692L);  ///< 2π
template <typename Scalar>
inline constexpr Scalar turns_per_rad = literal<Scalar>(0.159154943091895336L);  ///< 1/2π

}  // namespace millforce::estimation
