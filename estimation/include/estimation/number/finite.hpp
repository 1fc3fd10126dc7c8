// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::estimation {

/// Neither infinite nor NaN; fixed point always is. By one subtraction, which every scalar has. For the floats of hal,
/// also on chips without a floating-point unit: hal::is_finite(), which looks at their bits.
template <typename Scalar>
[[nodiscard]] constexpr bool is_finite(Scalar value) {
    return value - value == Scalar(0);
}

}  // namespace millforce::estimation
