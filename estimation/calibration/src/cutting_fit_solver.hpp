// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/cutting_fit.hpp"

#include "least_squares_in_double.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

/// The fit of fit_cutting_law: Gauss–Newton steps on Huber's loss, with priors.

namespace millforce::estimation {

/// One measured force, and what the model of it needs that does not change with the parameters:
///   F = f_z a_p N/2π · K_s (per_K + r_1 per_r) + a_p N/2π (K_te per_K_te + K_re per_K_re)
/// The four factors are those of F_at, F_ax or F_ay in cutting_law.hpp.
struct MeasuredForce {
    std::size_t channel = 0;  ///< 0: F_at, 1: F_ax, 2: F_ay
    double force_N = 0.0;
    double feed_per_tooth_mm = 0.0;
    double depth_per_pitch_mm = 0.0;  ///< a_p N/2π
    double ln_thickness = 0.0;        ///< logarithm of t_a in mm
    double per_K = 0.0;
    double per_r = 0.0;
    double per_K_te = 0.0;
    double per_K_re = 0.0;
};

/// The model's force, and its derivatives by the parameters.
struct ModelForce {
    double force_N = 0.0;
    CuttingParameters derivatives = CuttingParameters::Zero();
};

class CuttingFitSolver {
  public:
    CuttingFitSolver(std::span<const CuttingMeasurement> cuts, const CuttingFitOptions& options);

    CuttingFit run();

  private:
    static constexpr std::size_t channel_count = 3;

    /// What is known of the errors of F_at, F_ax or F_ay.
    struct Channel {
        double scale = 0.0;  ///< ρ
        double floor_N = 0.0;
        double relative_squares = 0.0;  ///< Σ (error/sd)² in units of ρ = 1
        double clipped_squares = 0.0;   ///< Σ min(z², k²), z in units of ρ, k Huber's limit
        int cuts = 0;
        int unclipped = 0;
        int odd = 0;
    };

    void take(const CuttingMeasurement& cut);
    bool start();
    void set_prior_weights(double K_s);
    double step();
    void measure_scatter();
    void conclude();
    void find_undetermined();
    void fill_law();
    void fill_standard_deviations();

    [[nodiscard]] ModelForce model(const MeasuredForce& measured) const;
    [[nodiscard]] double relative_sd(const MeasuredForce& measured, double model_N) const;
    [[nodiscard]] double extra_radial_variance(double tangential_rms) const;
    [[nodiscard]] double least_variance(int parameter) const;
    [[nodiscard]] double decided_by_cuts(int parameter) const;
    [[nodiscard]] double free_parameters() const;
    void add_priors(LeastSquares<double, cutting_parameter_count>& fit, bool steps_from_here) const;

    CuttingFitOptions options_;
    std::vector<MeasuredForce> forces_;
    CuttingFit result_{};
    std::array<Channel, channel_count> channels_{};
    CuttingParameters prior_mean_ = CuttingParameters::Zero();
    CuttingParameters prior_weight_ = CuttingParameters::Zero();  ///< 1/sd; 0: no prior
    double ln_t_ref_ = 0.0;
    double thinnest_mm_ = 0.0;
    double thickest_mm_ = 0.0;
};

}  // namespace millforce::estimation
