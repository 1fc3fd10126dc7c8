// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

/// Whether the teeth go on loading the spindle as they did a revolution before.
///
///   d_k = I_k − I_(k−z),   changed: |d_k| > max(3 σ, ΔI) for one, or |Σ d| > max(3 σ √n, n ΔI), n = min(k, z), for all
///
/// I_k: mean current of the k-th tooth period since start(), σ: the noise of a difference, ΔI: the least change that
/// counts, z: teeth. A jump shows in one tooth. A change that creeps shows in the sum: beyond a revolution all but its
/// first and last terms cancel, and it is z times what the mean over a revolution has changed by.
///
/// Currents in A. What is no number is a change. Not thread-safe.

namespace millforce::estimation {

template <typename Scalar>
class ToothRepetition {
  public:
    explicit ToothRepetition(int teeth = 1) : teeth_(teeth) {}

    /// What is to count as nothing from now on: σ² and ΔI ≥ 0. Before the first call that is 0.
    void set_scale(Scalar noise_A2, Scalar least_change_A) {
        noise_A2_ = square(deviations) * noise_A2;
        least_change_A2_ = square(least_change_A);
        of_one_A2_ = larger(noise_A2_, least_change_A2_);
    }

    /// What comes is compared anew.
    void start() {
        sum_A_ = Scalar(0);
        followed_ = 0;
        has_changed_ = false;
    }

    /// The next tooth: its mean current, and that of the same tooth a revolution before.
    void follow(Scalar tooth_A, Scalar before_A) {
        const Scalar change_A = tooth_A - before_A;
        sum_A_ += change_A;
        followed_ = followed_ < teeth_ ? followed_ + 1 : teeth_;
        const Scalar count = Scalar(followed_);
        has_changed_ = has_changed_ || !(square(change_A) <= of_one_A2_) ||
                       !(square(sum_A_) <= count * larger(noise_A2_, count * least_change_A2_));
    }

    /// There is nothing to compare the next tooth with: that is a change.
    void lose() { has_changed_ = true; }

    /// Since start().
    [[nodiscard]] bool has_changed() const { return has_changed_; }

  private:
    static constexpr Scalar deviations = static_cast<Scalar>(3);

    [[nodiscard]] static Scalar larger(Scalar a, Scalar b) { return a > b ? a : b; }

    int teeth_;
    int followed_ = 0;
    bool has_changed_ = true;
    Scalar noise_A2_{0};
    Scalar least_change_A2_{0};
    Scalar of_one_A2_{0};
    Scalar sum_A_{0};
};

}  // namespace millforce::estimation
