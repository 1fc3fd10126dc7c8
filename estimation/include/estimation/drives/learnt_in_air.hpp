// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

namespace millforce::estimation {

/// What re-zeroing in air may learn: a deviation from the calibration of at most four times its stated standard
/// deviation. What lies beyond is no drift: a channel that is dead, reversed or connected to another axis, or the
/// calibration of another machine.
template <typename Scalar>
[[nodiscard]] bool may_be_learnt_in_air(Scalar deviation, Scalar variance) {
    constexpr Scalar largest_in_deviations{4};
    return square(deviation) <= square(largest_in_deviations) * variance;
}

}  // namespace millforce::estimation
