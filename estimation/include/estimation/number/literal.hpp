// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::estimation {

/// A constant of a template over the scalar: literal<Scalar>(0.05L). It is written in long double, so that fixed point
/// loses no digit of it, and evaluated at compile time alone: no core has to compute in long double.
template <typename Scalar>
[[nodiscard]] consteval Scalar literal(auto value) {
    return static_cast<Scalar>(value);
}

}  // namespace millforce::estimation
