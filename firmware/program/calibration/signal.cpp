// SPDX-License-Identifier: Apache-2.0
#include "calibration/signal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace millforce::host {

namespace {

struct Biquad {
    double b0, b1, b2, a1, a2;
};

constexpr int sections = 2;

std::array<Biquad, sections> butterworth(double cutoff_hz, double sample_rate_hz) {
    const double K = std::tan(std::numbers::pi * cutoff_hz / sample_rate_hz);
    std::array<Biquad, sections> result{};
    for (int k = 0; k < sections; ++k) {
        const double damping = 2.0 * std::cos(std::numbers::pi * (2 * k + 1) / (4.0 * sections));
        const double norm = 1.0 / (1.0 + K * damping + K * K);
        result[static_cast<std::size_t>(k)] = {K * K * norm, 2.0 * K * K * norm, K * K * norm,
                                               2.0 * (K * K - 1.0) * norm, (1.0 - K * damping + K * K) * norm};
    }
    return result;
}

/// Starts in the steady state of the first sample.
void run(std::vector<double>& signal, const std::array<Biquad, sections>& filter) {
    for (const Biquad& section : filter) {
        double x1 = signal.front();
        double x2 = x1;
        double y1 = x1;
        double y2 = x1;
        for (double& sample : signal) {
            const double y =
                section.b0 * sample + section.b1 * x1 + section.b2 * x2 - section.a1 * y1 - section.a2 * y2;
            x2 = x1;
            x1 = sample;
            y2 = y1;
            y1 = y;
            sample = y;
        }
    }
}

}  // namespace

std::vector<double> zero_phase_low_pass(std::span<const double> signal, double cutoff_hz, double sample_rate_hz) {
    if (signal.size() < 2 || !(cutoff_hz < 0.5 * sample_rate_hz)) {
        return {signal.begin(), signal.end()};
    }
    const auto filter = butterworth(cutoff_hz, sample_rate_hz);
    const std::size_t padding = std::min(signal.size() - 1, static_cast<std::size_t>(3.0 * sample_rate_hz / cutoff_hz));
    std::vector<double> padded;
    padded.reserve(signal.size() + 2 * padding);
    for (std::size_t k = padding; k > 0; --k) {
        padded.push_back(2.0 * signal.front() - signal[k]);
    }
    padded.insert(padded.end(), signal.begin(), signal.end());
    for (std::size_t k = 1; k <= padding; ++k) {
        padded.push_back(2.0 * signal.back() - signal[signal.size() - 1 - k]);
    }
    run(padded, filter);
    std::reverse(padded.begin(), padded.end());
    run(padded, filter);
    std::reverse(padded.begin(), padded.end());
    const auto first = padded.begin() + static_cast<std::ptrdiff_t>(padding);
    return {first, first + static_cast<std::ptrdiff_t>(signal.size())};
}

std::vector<double> derivative(std::span<const double> signal, double dt_s) {
    const std::size_t n = signal.size();
    std::vector<double> result(n, 0.0);
    if (n < 5) {
        return result;
    }
    for (std::size_t k = 2; k + 2 < n; ++k) {
        result[k] = (8.0 * (signal[k + 1] - signal[k - 1]) - (signal[k + 2] - signal[k - 2])) / (12.0 * dt_s);
    }
    result[0] = result[1] = result[2];
    result[n - 1] = result[n - 2] = result[n - 3];
    return result;
}

std::vector<std::size_t> replace_spikes(std::vector<double>& signal) {
    constexpr std::size_t window = 7;
    constexpr double limit = 10.0;
    constexpr double sd_per_median = 1.4826;
    std::vector<std::size_t> places;
    if (signal.size() < window) {
        return places;
    }
    const auto median_of = [](auto first, auto last) {
        const auto middle = first + (last - first) / 2;
        std::nth_element(first, middle, last);
        return *middle;
    };
    std::vector<double> medians(signal.size());
    std::vector<double> distances(signal.size());
    for (std::size_t k = 0; k < signal.size(); ++k) {
        const std::size_t first = std::min(k - std::min(k, window / 2), signal.size() - window);
        std::array<double, window> around{};
        std::copy_n(signal.begin() + static_cast<std::ptrdiff_t>(first), window, around.begin());
        medians[k] = median_of(around.begin(), around.end());
        distances[k] = std::abs(signal[k] - medians[k]);
    }
    std::vector<double> sorted = distances;
    const double sd = sd_per_median * median_of(sorted.begin(), sorted.end());
    for (std::size_t k = 0; sd > 0.0 && k < signal.size(); ++k) {
        if (distances[k] > limit * sd) {
            signal[k] = medians[k];
            places.push_back(k);
        }
    }
    return places;
}

double correlated_samples(std::span<const double> residuals) {
    double variance = 0.0;
    for (const double residual : residuals) {
        variance += residual * residual;
    }
    double sum = 1.0;
    for (std::size_t lag = 1; variance > 0.0 && lag < residuals.size() / 4; ++lag) {
        double product = 0.0;
        for (std::size_t k = lag; k < residuals.size(); ++k) {
            product += residuals[k] * residuals[k - lag];
        }
        if (product <= 0.0) {
            break;
        }
        sum += 2.0 * product / variance;
    }
    return sum;
}

}  // namespace millforce::host
