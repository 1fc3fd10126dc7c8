// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::estimation {

/// A number with its variance, or "no estimate". `valid == false` is "no estimate": value and
/// variance then mean nothing, and nothing downstream may speed up on it.
template <typename Scalar>
struct Measurement {
    bool valid = false;
    Scalar value{0};
    Scalar variance{0};  ///< from all sources of uncertainty
    Scalar noise{0};     ///< the part of it that differs from window to window, and that averaging removes
};

template <typename Scalar>
constexpr Scalar square(Scalar value) {
    return value * value;
}

/// By a product: a division costs several.
template <typename Scalar>
constexpr Scalar halved(Scalar value) {
    return value * Scalar(0.5F);
}

/// a b. A scalar that multiplies by a call has an overload without one: for the few products of every sample.
template <typename Scalar>
constexpr Scalar product(Scalar a, Scalar b) {
    return a * b;
}

template <typename Scalar>
constexpr Scalar clamp(Scalar value, Scalar low, Scalar high) {
    return value < low ? low : (value > high ? high : value);
}

}  // namespace millforce::estimation
