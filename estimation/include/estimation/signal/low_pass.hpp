// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/circle.hpp"
#include "estimation/number/phasor.hpp"

#include <cmath>

namespace millforce::estimation {

/// An analog Butterworth low-pass that the signal went through before it was sampled.
template <typename Scalar>
struct LowPass {
    int poles = 0;  ///< 0 (none) … 4
    Scalar cutoff_Hz{0};
};

/// H(f), f ≥ 0: the product over pole pairs of 1/(1 − x² + 2i x sin(π(2k − 1)/2n)), x = f/f_c, and 1/(1 + ix) for odd
/// n.
template <typename Scalar>
Phasor<Scalar> low_pass_response(const LowPass<Scalar>& filter, Scalar frequency_Hz) {
    using std::sin;
    Phasor<Scalar> response{Scalar(1), Scalar(0)};
    if (filter.poles <= 0 || !(filter.cutoff_Hz > Scalar(0))) {
        return response;
    }
    const Scalar x = frequency_Hz / filter.cutoff_Hz;
    for (int pair = 1; 2 * pair <= filter.poles; ++pair) {
        const Scalar damping = Scalar(2) * sin(pi<Scalar> * Scalar(2 * pair - 1) / Scalar(2 * filter.poles));
        response = response * reciprocal(Phasor<Scalar>{Scalar(1) - x * x, damping * x});
    }
    return filter.poles % 2 == 1 ? response * reciprocal(Phasor<Scalar>{Scalar(1), x}) : response;
}

}  // namespace millforce::estimation
