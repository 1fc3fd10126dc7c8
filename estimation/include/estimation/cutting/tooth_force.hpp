// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/engagement_peaks.hpp"
#include "estimation/number/elementary.hpp"

#include <cmath>

namespace millforce::estimation {

/// The peak force of one tooth from the mean tangential force, with its deviation or its bound; what it would be at
/// another immersion; and how it grows.
///
///   F_tooth = F_at τ (1 + e/f_z)^m       τ: engagement_peaks.hpp, e: runout, F ∝ f^m
///
/// Cost: three exponentials and two logarithms. Not thread-safe.
template <typename Scalar>
class ToothForce {
  public:
    using Table = typename EngagementSolver<Scalar>::Table;

    ToothForce() = default;
    ToothForce(const CutEstimatorSettings<Scalar>& settings, const CuttingLaw<Scalar>& law)
        : teeth_(settings.teeth),
          cutter_radius_mm_(settings.cutter_radius_mm),
          runout_mm_(settings.runout_mm),
          feed_exponent_(Scalar(1) + law.p_s) {}

    /// Fills in what F_at, feed and engagement of `e` tell of one tooth. The peaks are those at the immersion that is
    /// known, else at the last one, else at the assumed one.
    void fill(CutEstimate<Scalar>& e, const EngagementPeaks<Scalar>& peaks, const Table& table) {
        using std::sqrt;
        const auto feed = table.feed(e.feed_per_tooth_mm);
        const auto model = table.forces(peaks.here_node(), feed);
        const bool has_model = model.tangential_N > Scalar(0) && e.feed_per_tooth_mm > Scalar(0);
        const Scalar per_model_N = has_model ? Scalar(1) / model.tangential_N : Scalar(0);
        e.cutting_share = has_model ? model.cutting_tangential_N * per_model_N : Scalar(1);
        e.feed_exponent = feed_exponent_;
        force_exponent_ = e.feed_exponent * e.cutting_share;
        if (!e.tangential_N.valid) {
            return;
        }
        const Scalar newest_N = follow_growth(e);
        if (has_model) {
            const Scalar width_per_F_mm_N = peaks.now().radial_immersion * cutter_radius_mm_ * per_model_N;
            e.section_mm2 = e.tangential_N.value * width_per_F_mm_N;
            e.section_noise_mm2 = sqrt(e.tangential_N.noise) * width_per_F_mm_N;
        }
        estimate_tooth_force(e, peaks.factors(), newest_N);
        if (has_model) {
            const Scalar now_N = model.tangential_N * peaks.factors().now;
            if (peaks.surge_is_wider()) {
                e.surge = change_to(table.forces(peaks.surge_node(), feed), peaks.factors().surge, now_N);
            }
            if (peaks.turn_is_wider()) {
                e.turn = change_to(table.forces(peaks.turn_node(), feed), peaks.factors().turn, now_N);
            }
        }
    }

    /// m of F ∝ f^m at the last engagement.
    [[nodiscard]] Scalar force_exponent() const { return force_exponent_; }

  private:
    using Factors = typename EngagementPeaks<Scalar>::Factors;

    /// F_at of the window, or of the last tooth where that is clearly higher; and how fast it grows then.
    static Scalar follow_growth(CutEstimate<Scalar>& e) {
        const Measurement<Scalar>& window = e.tangential_N;
        const Measurement<Scalar>& tooth = e.tooth_tangential_N;
        const Scalar rise_N = tooth.value - window.value;
        const bool has_risen =
            tooth.valid && rise_N > Scalar(0) && square(rise_N) > square(Scalar(2)) * tooth.variance;  // two deviations
        e.newest_tangential_N = has_risen ? tooth.value : window.value;
        const Scalar half_window_s = halved(e.window_s);
        if (has_risen && half_window_s > Scalar(0)) {
            // The window's middle is half a window old, the last tooth's nearly now.
            e.tangential_growth_N_per_s = rise_N / half_window_s;
        }
        return e.newest_tangential_N;
    }

    void estimate_tooth_force(CutEstimate<Scalar>& e, const Factors& factors, Scalar newest_N) const {
        const EngagementEstimate<Scalar>& cut = e.engagement;
        const Measurement<Scalar>& window = e.tangential_N;
        const Scalar runout = runout_factor(e.feed_per_tooth_mm);
        e.worst_tooth_force_N = newest_N * factors.now * runout;
        e.least_tooth_force_N = newest_N * factors.slot;
        const auto bound_by = [&](Scalar bound) {
            const Scalar ratio = runout * (bound > factors.now ? bound : factors.now);
            e.tooth_force_N = {true, newest_N * ratio, square(ratio) * window.variance, Scalar(0)};
            e.tooth_force_is_bound = true;
        };
        if (cut.immersion_valid) {
            // At the narrow end of a wide interval it is nearly the most that the force can be: a quarter above the
            // middle.
            const Scalar both_ends = factors.at_low + factors.at_high;
            e.tooth_force_is_bound = factors.now + factors.now > Scalar(1.25F) * both_ends;
            const Scalar factor_sd = (factors.at_low - factors.at_high) * static_cast<Scalar>(1.0L / 3.92L);
            const Scalar by_factor = square(newest_N) * (square(factor_sd) + square(factors.by_K_s));
            e.tooth_force_N = {true, e.worst_tooth_force_N,
                               square(runout) * (square(factors.now) * window.variance + by_factor), Scalar(0)};
        } else if (cut.solved && cut.depth_at_high_mm > Scalar(0)) {
            // No estimate of the immersion, but a bound: the narrowest cut and the smallest depth that the forces allow
            // load one tooth most. Where even that is far from the limit, the force is known well enough.
            bound_by(factors.bound);
        } else if (!cut.solved && !e.x_N.valid && !e.y_N.valid) {
            // Axes too slow to show a force would stay so for ever without a bound: the narrowest and shallowest cut.
            bound_by(factors.narrowest);
        }
    }

    /// The tooth that stands out furthest takes (f_z + e) of chip where the mean takes f_z.
    [[nodiscard]] Scalar runout_factor(Scalar feed_per_tooth_mm) const {
        using elementary::exp;
        using elementary::log;
        if (!(runout_mm_ > Scalar(0)) || !(feed_per_tooth_mm > Scalar(0))) {
            return Scalar(1);
        }
        // More than all teeth's chips one tooth cannot take.
        const Scalar chip = clamp(Scalar(1) + runout_mm_ / feed_per_tooth_mm, Scalar(1), teeth_);
        return exp(force_exponent_ * log(chip));
    }

    [[nodiscard]] static typename CutEstimate<Scalar>::Change change_to(const typename Table::Forces& forces_then,
                                                                        Scalar factor, Scalar tooth_N_per_mm_now) {
        return {forces_then.tangential_N * factor / tooth_N_per_mm_now,
                forces_then.cutting_tangential_N / forces_then.tangential_N};
    }

    Scalar teeth_{4};
    Scalar cutter_radius_mm_{5};
    Scalar runout_mm_{0};
    Scalar feed_exponent_{static_cast<Scalar>(0.75L)};
    Scalar force_exponent_{static_cast<Scalar>(0.75L)};
};

}  // namespace millforce::estimation
