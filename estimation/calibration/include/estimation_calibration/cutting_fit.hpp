// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"

#include <Eigen/Core>

#include <limits>
#include <span>

/// Coefficients of a CuttingLaw from cuts with known geometry and measured average forces.
///
/// Laws. The linear edge law has the right slope between calibrated feeds and too much force below them; the power law
/// (Kim & Chung Eq. 5) bends the right way and misses the middle. The combined law has both, and two or three feeds
/// cannot separate its exponents from its edge forces. So the fit starts from published values and lets the cuts decide
/// as far as they can. The priors are p_s = −0.265 ± 0.1 and p_1 = −0.19 ± 0.1 (means of Kim & Chung's Tables 2 and 4),
/// and edge forces of 0 ± K_s · 5 µm (an edge force is of the order of K_s times the radius of the cutting edge).
///
/// Errors. A mean force is wrong in proportion to itself (chip area, width, runout), with a floor for small ones:
/// sd = ρ · hypot(F, floor · mean|F|), ρ estimated for each of F_at, F_ax, F_ay. Huber's loss keeps a cut that was not
/// cut as stated (a width wrong by a tenth) from bending the law: within 1.345 ρ it counts in full, beyond it linearly.
///
/// Parameters fitted: ln K_s(t_ref), p_s, r_1(t_ref), p_1, K_te, K_re; t_ref = geometric mean of the chip thicknesses.

namespace millforce::estimation {

/// One cut: geometry, and what was measured. A force that was not measured is NaN.
struct CuttingMeasurement {
    CutConditions<double> cut{};
    double tangential_N = std::numeric_limits<double>::quiet_NaN();
    double feed_N = std::numeric_limits<double>::quiet_NaN();
    double normal_N = std::numeric_limits<double>::quiet_NaN();
};

enum class CuttingLawForm : unsigned char {
    linear_edge,  ///< p_s = p_1 = 0
    power,        ///< K_te = K_re = 0
    combined,     ///< all six, with the priors above
};

struct CuttingFitOptions {
    CuttingLawForm form = CuttingLawForm::combined;
    double p_s_mean = -0.265;
    double p_s_sd = 0.1;
    double p_1_mean = -0.19;
    double p_1_sd = 0.1;
    double edge_thickness_sd_mm = 0.005;  ///< sd of K_te/K_s and K_re/K_s
    double error_floor = 0.1;             ///< share of the mean force below which errors are constant
    double huber_limit = 1.345;           ///< 95 % efficient for normal errors
    double minimum_feed_ratio = 1.2;      ///< largest over smallest feed per tooth
    unsigned held_at_zero = 0;            ///< bit j of CuttingFitIndex: p_s, p_1, K_te or K_re is 0, and not fitted
};

enum CuttingFitIndex : int {
    cutting_ln_K_s,
    cutting_p_s,
    cutting_r_1,
    cutting_p_1,
    cutting_K_te,
    cutting_K_re,
    cutting_parameter_count
};

/// In the order of CuttingFitIndex.
using CuttingParameters = Eigen::Matrix<double, cutting_parameter_count, 1>;
using CuttingCovariance = Eigen::Matrix<double, cutting_parameter_count, cutting_parameter_count>;

/// How the forces of one kind (F_at, F_ax or F_ay) scatter about the law, relative to hypot(F, floor · mean|F|).
struct CuttingScatter {
    double robust_sd = 0.0;  ///< deviation of the cuts without the odd ones (Huber's proposal 2)
    double rms = 0.0;        ///< residual of all cuts
    double floor_N = 0.0;    ///< floor · mean|F|
    int cuts = 0;
    int odd_cuts = 0;  ///< beyond the Huber limit by three more standard deviations
};

struct CuttingFit {
    /// Its standard deviations cover the covariance of the parameters and the scatter of single cuts together. Twice a
    /// deviation is a 95 % band by Student's t, however few the cuts; none is zero. The reference chip thickness is the
    /// one within the range of the cuts at which K_s is known best.
    CuttingLaw<double> law{};
    CuttingParameters parameters = CuttingParameters::Zero();
    CuttingCovariance covariance = CuttingCovariance::Zero();
    CuttingParameters decided_by_cuts = CuttingParameters::Zero();  ///< 0: by the prior alone, 1: by the cuts alone
    double degrees_of_freedom = 0.0;           ///< measured forces less the parameters that the cuts decide
    double reference_chip_thickness_mm = 0.0;  ///< t_ref of the parameters
    double minimum_feed_per_tooth_mm = 0.0;
    double maximum_feed_per_tooth_mm = 0.0;
    CuttingScatter tangential{}, feed{}, normal{};
    unsigned undetermined = 0;  ///< bit j: these cuts cannot determine parameter j; `law` must then not be used
    bool converged = false;

    [[nodiscard]] bool determined(int j) const { return ((undetermined >> static_cast<unsigned>(j)) & 1U) == 0U; }
    [[nodiscard]] double standard_error(int j) const;
    /// Standard errors of the coefficients at t = 1 mm, as the law holds them.
    [[nodiscard]] double k_s_standard_error() const;
    [[nodiscard]] double k_1_standard_error() const;
};

/// Fits the cuts; see above. Cuts with no engagement, no feed or non-finite geometry are left out.
///
/// `undetermined` names what is missing: K_te, K_re and the exponents with one feed per tooth only; K_s without a
/// finite force; r_1, p_1 and K_re where only torques were measured, or normal forces in slots alone (s = 0 there). The
/// cuts are read some 40 times.
[[nodiscard]] CuttingFit fit_cutting_law(std::span<const CuttingMeasurement> cuts,
                                         const CuttingFitOptions& options = {});

}  // namespace millforce::estimation
