// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

/// Helpers of the tests of fits: seeded noise, and counting how often an interval covers the truth.

namespace millforce::test {

/// Two-sided 95 % quantile of Student's t (Cornish–Fisher to second order: within 0.5 % for 8 or more degrees of
/// freedom).
inline double student_t_95(double freedom) {
    const double z = 1.959964;
    return z + (z * z * z + z) / (4.0 * freedom) +
           (5.0 * std::pow(z, 5.0) + 16.0 * z * z * z + 3.0 * z) / (96.0 * freedom * freedom);
}

/// Share of repetitions in which truth lay within ± quantile · standard error of the estimate.
class Coverage {
  public:
    void add(double truth, double estimate, double standard_error, double quantile) {
        ++trials_;
        covered_ += std::abs(estimate - truth) <= quantile * standard_error ? 1 : 0;
    }
    double percent() const { return 100.0 * covered_ / trials_; }

  private:
    int trials_ = 0;
    int covered_ = 0;
};

class Noise {
  public:
    explicit Noise(unsigned seed) : generator_(seed) {}
    double normal(double sd) { return sd * normal_(generator_); }
    double uniform(double low, double high) { return low + (high - low) * uniform_(generator_); }

  private:
    std::mt19937 generator_;
    std::normal_distribution<double> normal_{0.0, 1.0};
    std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

}  // namespace millforce::test
