// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Filtering and differentiation of whole recordings, without phase shift. For the host: it needs the future.

namespace millforce::host {

/// Butterworth low-pass of fourth order, run forward and backward: no phase shift, gain ½ at the cutoff. The ends are
/// extended by point reflection over three periods of the cutoff. Cutoffs at or above half the sample rate: the signal
/// unchanged.
std::vector<double> zero_phase_low_pass(std::span<const double> signal, double cutoff_hz, double sample_rate_hz);

/// dx/dt by five-point central differences (error of fourth order in dt). The two samples at each end repeat their
/// neighbour. Fewer than five samples: zeros.
std::vector<double> derivative(std::span<const double> signal, double dt_s);

/// Replaces single samples that stand out by the median of the seven around them, and returns their places. A sample
/// stands out by more than ten robust standard deviations of such distances over the whole signal; steps do not.
std::vector<std::size_t> replace_spikes(std::vector<double>& signal);

/// How many samples of a correlated sequence are worth one independent sample: 1 + 2 Σ ρ_k up to the first ρ_k ≤ 0, ρ_k
/// the autocorrelation at lag k. At least 1.
double correlated_samples(std::span<const double> residuals);

}  // namespace millforce::host
