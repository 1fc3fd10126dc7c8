// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

namespace millforce::estimation {

/// What a change of current between two averages of so many samples is as a force. Its variance is their noise alone:
/// `noise_ratio` times that of current_sd_A (noise_ratio.hpp).
template <typename Scalar>
[[nodiscard]] Measurement<Scalar> force_change_N(Scalar change_A, Scalar N_per_A, Scalar current_sd_A,
                                                 Scalar noise_ratio, Scalar samples) {
    const Scalar noise = Scalar(2) * square(N_per_A * current_sd_A) * noise_ratio / samples;
    return {true, N_per_A * change_A, noise, noise};
}

}  // namespace millforce::estimation
