// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

/// A complex number for Fourier sums. std::complex checks every product for NaN, which costs more than the product.

namespace millforce::estimation {

template <typename Scalar>
struct Phasor {
    Scalar re{0};
    Scalar im{0};

    constexpr Phasor& operator+=(Phasor b) { return *this = {re + b.re, im + b.im}; }
    constexpr Phasor& operator-=(Phasor b) { return *this = {re - b.re, im - b.im}; }
    friend constexpr Phasor operator+(Phasor a, Phasor b) { return {a.re + b.re, a.im + b.im}; }
    friend constexpr Phasor operator-(Phasor a, Phasor b) { return {a.re - b.re, a.im - b.im}; }
    friend constexpr Phasor operator*(Phasor a, Phasor b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    friend constexpr Phasor operator*(Phasor a, Scalar s) { return {a.re * s, a.im * s}; }
};

template <typename Scalar>
constexpr Phasor<Scalar> conjugate(Phasor<Scalar> a) {
    return {a.re, -a.im};
}

template <typename Scalar>
constexpr Scalar squared_length(Phasor<Scalar> a) {
    return a.re * a.re + a.im * a.im;
}

/// a/i: a quarter turn back.
template <typename Scalar>
constexpr Phasor<Scalar> over_i(Phasor<Scalar> a) {
    return {a.im, -a.re};
}

/// 1/a; zero for zero.
template <typename Scalar>
constexpr Phasor<Scalar> reciprocal(Phasor<Scalar> a) {
    const Scalar square = squared_length(a);
    return square > Scalar(0) ? conjugate(a) * (Scalar(1) / square) : Phasor<Scalar>{};
}

/// e^{ix}.
template <typename Scalar>
Phasor<Scalar> turned_by(Scalar angle_rad) {
    using std::cos;
    using std::sin;
    return {cos(angle_rad), sin(angle_rad)};
}

/// a^n, n ≥ 0 and small.
template <typename Scalar>
constexpr Phasor<Scalar> power(Phasor<Scalar> a, int n) {
    Phasor<Scalar> product{Scalar(1), Scalar(0)};
    for (int k = 0; k < n; ++k) {
        product = product * a;
    }
    return product;
}

}  // namespace millforce::estimation
