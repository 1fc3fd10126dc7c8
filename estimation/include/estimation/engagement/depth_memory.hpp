// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/engagement/immersion_profile.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <cmath>

namespace millforce::estimation {

/// The last axial depth that the forces determined. It is used in a cut whose forces do not determine it: in up milling
/// below R_r = 0.6 with one moving axis, F_at and F_ax fit many pairs of immersion and depth. A tool that keeps its
/// height keeps its depth, while the immersion changes at every corner.
///
/// The depth is the mean of the last estimates, at most sixteen. Its standard deviation grows with the travel: by
/// 2 % per square root of a millimetre in the plane, since a raw part is not flat, and by each millimetre along the
/// tool's axis. Beyond 30 % there is no remembered depth. Not thread-safe.
template <typename Scalar>
class DepthMemory {
  public:
    void follow(Scalar travel_mm, Scalar axial_travel_mm) {
        using std::sqrt;
        if (estimates_ == 0) {
            return;
        }
        constexpr Scalar walk_per_sqrt_mm = literal<Scalar>(0.02L);
        const Scalar axial = axial_travel_mm < Scalar(0) ? -axial_travel_mm : axial_travel_mm;
        relative_sd_ = sqrt(square(relative_sd_) + square(walk_per_sqrt_mm) * travel_mm) + axial / depth_mm_;
        if (!(relative_sd_ < largest_relative_sd)) {
            forget();
        }
    }

    /// An estimate from forces alone, in a cut that neither begins nor ends. One without a depth changes nothing.
    /// Another depth is accepted once `most_estimates` estimates in a row have given it.
    void learn(const EngagementEstimate<Scalar>& found) {
        if (!found.depth_valid || !(found.axial_depth_force_sd_mm < largest_relative_sd * found.axial_depth_mm)) {
            return;
        }
        constexpr Scalar clear_deviations{3};
        const Scalar doubt_mm = found.axial_depth_force_sd_mm + relative_sd_ * depth_mm_;
        const Scalar apart_mm = found.axial_depth_mm - depth_mm_;
        const bool is_another = estimates_ > 0 && !(square(apart_mm) < square(clear_deviations * doubt_mm));
        others_in_a_row_ = is_another ? others_in_a_row_ + 1 : 0;
        if (is_another && others_in_a_row_ < most_estimates) {
            return;
        }
        if (is_another) {
            forget();
        }
        estimates_ = estimates_ < most_estimates ? estimates_ + 1 : most_estimates;
        const Scalar share = Scalar(1) / Scalar(estimates_);
        depth_mm_ += share * (found.axial_depth_mm - depth_mm_);
        relative_sd_ += share * (found.axial_depth_force_sd_mm / found.axial_depth_mm - relative_sd_);
    }

    void forget() { *this = {}; }

    /// Found with the same K_s as the forces that it is used with: the uncertainty of K_s is not part of it.
    [[nodiscard]] KnownDepth<Scalar> depth() const { return {depth_mm_, relative_sd_, false}; }

  private:
    static constexpr Scalar largest_relative_sd = literal<Scalar>(0.3L);
    static constexpr int most_estimates = 16;

    Scalar depth_mm_{0};  // 0: none
    Scalar relative_sd_{0};
    int estimates_ = 0;  // in the mean
    int others_in_a_row_ = 0;
};

}  // namespace millforce::estimation
