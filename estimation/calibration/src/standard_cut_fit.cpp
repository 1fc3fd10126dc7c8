// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/standard_cut_fit.hpp"

#include "least_squares_in_double.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::estimation {

namespace {

/// Where the parameters of I = load/gain + … stand in the solution.
struct GainIndices {
    int gain;
    int offset;
    int nuisance;
};

/// gain = 1/a and offset = sign · b/a, with a and b the parameters at `at.gain` and `at.offset`.
void fill_gain(const LeastSquaresSolution<double, 3>& solution, GainIndices at, double sign, DriveGainFit& fit) {
    const double per_a = 1.0 / solution.parameters(at.gain);
    const double ratio = solution.parameters(at.offset) * per_a;
    const auto& covariance = solution.covariance;
    fit.rows = solution.rows;
    fit.residual_A = solution.residual_sd;
    fit.gain = per_a;
    fit.gain_se = per_a * per_a * solution.standard_error(at.gain);
    fit.offset = sign * ratio;
    fit.offset_se = per_a * std::sqrt(covariance(at.offset, at.offset) + ratio * ratio * covariance(at.gain, at.gain) -
                                      2.0 * ratio * covariance(at.gain, at.offset));
    fit.nuisance = solution.parameters(at.nuisance);
    fit.nuisance_se = solution.standard_error(at.nuisance);
}

StandardCutLack lack_of_fit(const LeastSquaresSolution<double, 3>& solution, GainIndices at, int free_parameters) {
    constexpr double least_significance = 3.0;  // of 1/gain, in standard errors
    if (solution.rows <= free_parameters) {
        return StandardCutLack::rows;
    }
    const bool determined = solution.determined(at.gain) && solution.determined(at.offset);
    const bool follows = solution.parameters(at.gain) > least_significance * solution.standard_error(at.gain);
    return determined && follows ? StandardCutLack::nothing : StandardCutLack::response;
}

/// Smallest and largest size of what the cuts have.
class Extent {
  public:
    void add(double value) {
        const double size = std::abs(value);
        smallest_ = count_ == 0 ? size : std::min(size, smallest_);
        largest_ = std::max(size, largest_);
        ++count_;
    }
    [[nodiscard]] bool spans(double ratio) const { return largest_ > ratio * smallest_; }
    [[nodiscard]] int count() const { return count_; }

  private:
    double smallest_ = 0.0;
    double largest_ = 0.0;
    int count_ = 0;
};

/// What is missing whatever the currents are.
StandardCutLack lack_of_cuts(int rows, const Extent& loads) {
    if (loads.count() == 0) {
        return StandardCutLack::cut;
    }
    return rows == loads.count() ? StandardCutLack::air : StandardCutLack::nothing;
}

}  // namespace

DriveGainFit fit_spindle_gain(std::span<const StandardCutStretch> stretches, const StandardCutRules& rules) {
    constexpr GainIndices at{.gain = 0, .offset = 1, .nuisance = 2};
    constexpr double no_cold_excess = 1e3;  // weight in 1/A: far more than the rows have
    LeastSquares<double, 3> fit;
    Extent loads;
    bool drifts = false;
    for (const StandardCutStretch& s : stretches) {
        if (s.in_cut) {
            loads.add(s.torque_Nm);
        }
        drifts = drifts || s.drift != stretches.front().drift;
        fit.add({s.torque_Nm, 1.0, s.drift}, s.spindle_current_A, s.weight);
    }
    if (!drifts) {
        fit.add_prior(at.nuisance, 0.0, no_cold_excess);
    }
    DriveGainFit result;
    result.lack = lack_of_cuts(fit.rows(), loads);
    if (result.lack == StandardCutLack::nothing && !loads.spans(rules.least_load_ratio)) {
        result.lack = StandardCutLack::second_load;
    }
    if (result.lack != StandardCutLack::nothing) {
        return result;
    }
    const auto solution = fit.solve();
    result.lack = lack_of_fit(solution, at, drifts ? 3 : 2);
    if (result.lack == StandardCutLack::nothing) {
        fill_gain(solution, at, -1.0, result);
    }
    return result;
}

DriveGainFit fit_feed_gain(std::span<const StandardCutStretch> stretches, const StandardCutRules& rules) {
    constexpr GainIndices at{.gain = 1, .offset = 2, .nuisance = 0};
    LeastSquares<double, 3> fit;
    Extent loads;
    Extent feeds;
    for (const StandardCutStretch& s : stretches) {
        if (s.in_cut) {
            loads.add(s.feed_force_N);
            feeds.add(s.feed_m_per_min);
        }
        fit.add({s.friction_current_A, s.feed_force_N, -1.0 / s.feed_m_per_min}, s.feed_current_A, s.weight);
    }
    DriveGainFit result;
    result.lack = lack_of_cuts(fit.rows(), loads);
    if (result.lack == StandardCutLack::nothing && !feeds.spans(rules.least_feed_ratio)) {
        result.lack = StandardCutLack::second_feed;
    } else if (result.lack == StandardCutLack::nothing && !loads.spans(rules.least_load_ratio)) {
        result.lack = StandardCutLack::second_load;
    }
    if (result.lack != StandardCutLack::nothing) {
        return result;
    }
    if (!rules.fits_K_x5) {
        constexpr double no_K_x5 = 1e9;  // weight: far more than the rows have
        fit.add_prior(at.offset, 0.0, no_K_x5);
    }
    const auto solution = fit.solve();
    result.lack = lack_of_fit(solution, at, rules.fits_K_x5 ? 3 : 2);
    if (result.lack == StandardCutLack::nothing) {
        fill_gain(solution, at, 1.0, result);
    }
    return result;
}

}  // namespace millforce::estimation
