// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::estimation {

/// Neither infinite nor NaN. Fixed point always is.
template <typename Scalar>
[[nodiscard]] constexpr bool is_finite(Scalar value) {
    return value - value == Scalar(0);
}

}  // namespace millforce::estimation
