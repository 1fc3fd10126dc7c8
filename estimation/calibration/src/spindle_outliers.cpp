// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/spindle_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace millforce::estimation {

namespace {

using Samples = std::vector<SpindleSample>;

/// Idle running and cuts are judged apart: most rows of a recording may be idle, and hold whatever K_t1 is.
class TwoLoads {
  public:
    explicit TwoLoads(std::span<const SpindleSample> samples) {
        constexpr double idle_share = 0.1;
        constexpr double not_an_outlier = 0.9;
        std::vector<double> sizes;
        sizes.reserve(samples.size());
        for (const SpindleSample& sample : samples) {
            sizes.push_back(std::abs(sample.torque_Nm));
        }
        torque_Nm_ = quantile(sizes, not_an_outlier);
        limit_Nm_ = idle_share * torque_Nm_;
    }
    /// That of a heavy cut.
    [[nodiscard]] double torque_Nm() const { return torque_Nm_; }
    [[nodiscard]] std::size_t of(const SpindleSample& sample) const {
        return std::abs(sample.torque_Nm) > limit_Nm_ ? 1 : 0;
    }

    /// Of the distances between the samples and the fit, of either load. 0 where there is no sample.
    [[nodiscard]] std::array<double, 2> distances_Nm(std::span<const SpindleSample> samples, const SpindleFit& fit,
                                                     double share) const {
        std::array<std::vector<double>, 2> sizes;
        for (const SpindleSample& sample : samples) {
            sizes[of(sample)].push_back(std::abs(sample.torque_Nm - spindle_torque_Nm(fit, sample)));
        }
        return {quantile(sizes[0], share), quantile(sizes[1], share)};
    }

  private:
    static double quantile(std::vector<double>& values, double share) {
        if (values.empty()) {
            return 0.0;
        }
        const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), values.begin() + place, values.end());
        return values[static_cast<std::size_t>(place)];
    }

    double torque_Nm_ = 0.0;
    double limit_Nm_ = 0.0;
};

/// Every so many samples, so that no more than `most` are left.
Samples thinned(std::span<const SpindleSample> samples, std::size_t most) {
    const std::size_t step = samples.size() / most + 1;
    Samples result;
    for (std::size_t k = 0; k < samples.size(); k += step) {
        result.push_back(samples[k]);
    }
    return result;
}

/// A fit that outliers have no part in, by trial.
SpindleFit undisturbed_fit(std::span<const SpindleSample> all, SpindleFitTerms terms, const TwoLoads& loads) {
    constexpr std::size_t most_samples = 2000;
    constexpr int trials = 400;
    constexpr std::size_t drawn = 6;  // one more than there are parameters
    constexpr double share = 0.85;
    const Samples samples = thinned(all, most_samples);
    const auto misfit = [&](const SpindleFit& fit) {
        const auto distances = loads.distances_Nm(samples, fit, share);
        return distances[0] + distances[1];
    };
    SpindleFit best = fit_spindle(samples, terms);
    double least = misfit(best);
    std::mt19937_64 random(1);
    for (int trial = 0; trial < trials; ++trial) {
        Samples few;
        for (std::size_t k = 0; k < drawn; ++k) {
            few.push_back(samples[random() % samples.size()]);
        }
        const auto [slowest, fastest] = std::ranges::minmax(few, {}, &SpindleSample::speed_rad_s);
        SpindleFitTerms terms_of_few = terms;
        terms_of_few.field_weakening = terms.field_weakening && fastest.speed_rad_s > slowest.speed_rad_s;
        const SpindleFit fit = fit_spindle(few, terms_of_few, 0.0);
        if (fit.solution.undetermined == 0U && misfit(fit) < least) {
            best = fit;
            least = misfit(fit);
        }
    }
    return best;
}

}  // namespace

double spindle_torque_Nm(const SpindleFit& fit, const SpindleSample& sample) {
    const auto& p = fit.solution.parameters;
    return p(spindle_K_t1) * field_weakening_gain(p(spindle_base_speed), sample.speed_rad_s) * sample.current_A +
           p(spindle_K_t2) - p(spindle_idle_slope) * sample.speed_rad_s -
           p(spindle_inertia) * sample.acceleration_rad_s2;
}

TrimmedSpindleFit fit_spindle_without_outliers(std::span<const SpindleSample> samples, SpindleFitTerms terms) {
    constexpr double limit = 6.0;
    constexpr double sd_per_median = 1.4826;
    constexpr double least_share = 1e-6;  // of the torque: values without errors, as in a test, have no scatter
    constexpr int most_passes = 20;
    TrimmedSpindleFit result;
    if (samples.empty()) {
        return result;
    }
    const TwoLoads loads(samples);
    result.fit = undisturbed_fit(samples, terms, loads);
    for (; result.passes < most_passes; ++result.passes) {
        const auto medians = loads.distances_Nm(samples, result.fit, 0.5);
        Samples kept;
        std::vector<std::size_t> outliers;
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const double sd = sd_per_median * medians[loads.of(samples[k])];
            const double distance = std::abs(samples[k].torque_Nm - spindle_torque_Nm(result.fit, samples[k]));
            if (distance > limit * sd + least_share * loads.torque_Nm()) {
                outliers.push_back(k);
            } else {
                kept.push_back(samples[k]);
            }
        }
        const bool settled = result.passes > 0 && outliers == result.outliers;
        result.outliers = std::move(outliers);
        if (settled) {
            break;
        }
        result.fit = fit_spindle(kept, terms);
    }
    return result;
}

}  // namespace millforce::estimation
