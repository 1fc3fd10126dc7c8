// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"
#include "estimation/number/least_squares.hpp"

#include <cmath>
#include <limits>
#include <span>

/// Coefficients of a CuttingLaw from cuts with known geometry and measured average forces.
///
/// Laws. The linear edge law has the right slope between calibrated feeds and too much force below them; the power law
/// (Kim & Chung Eq. 5) bends the right way and misses the middle. The combined law has both, and two or three feeds
/// cannot tell its exponents from its edge forces. So it starts from what is published and lets the cuts decide as far
/// as they can: p_s = −0.265 ± 0.1 and p_1 = −0.19 ± 0.1 (means of Kim & Chung's Tables 2 and 4), edge forces 0 ± K_s ·
/// 5 µm (an edge force is of the order of K_s times the radius of the cutting edge).
///
/// Errors. A mean force is wrong in proportion to itself (chip area, width, runout), with a floor for small ones:
/// sd = ρ · hypot(F, floor · mean|F|), ρ estimated for each of F_at, F_ax, F_ay. Huber's loss keeps a cut that was not
/// cut as stated (a width wrong by a tenth) from bending the law: within 1.345 ρ it counts in full, beyond it linearly.
///
/// Parameters fitted: ln K_s(t_ref), p_s, r_1(t_ref), p_1, K_te, K_re; t_ref = geometric mean of the chip thicknesses.

namespace millforce::estimation {

/// One cut: geometry, and what was measured. A force that was not measured is NaN.
template <typename Scalar>
struct CuttingMeasurement {
    CutConditions<Scalar> cut{};
    Scalar tangential_N = std::numeric_limits<Scalar>::quiet_NaN();
    Scalar feed_N = std::numeric_limits<Scalar>::quiet_NaN();
    Scalar normal_N = std::numeric_limits<Scalar>::quiet_NaN();
};

enum class CuttingLawForm : unsigned char {
    linear_edge,  ///< p_s = p_1 = 0.
    power,        ///< K_te = K_re = 0.
    combined,     ///< all six, with published exponents as a starting belief.
};

template <typename Scalar>
struct CuttingFitOptions {
    CuttingLawForm form = CuttingLawForm::combined;
    Scalar p_s_mean{static_cast<Scalar>(-0.265L)};
    Scalar p_s_sd{static_cast<Scalar>(0.1L)};
    Scalar p_1_mean{static_cast<Scalar>(-0.19L)};
    Scalar p_1_sd{static_cast<Scalar>(0.1L)};
    Scalar edge_thickness_sd_mm{static_cast<Scalar>(0.005L)};  ///< sd of K_te/K_s and K_re/K_s.
    Scalar error_floor{static_cast<Scalar>(0.1L)};         ///< share of the mean force below which errors are constant.
    Scalar huber_limit{static_cast<Scalar>(1.345L)};       ///< 95 % efficient for normal errors.
    Scalar minimum_feed_ratio{static_cast<Scalar>(1.2L)};  ///< largest over smallest feed per tooth.
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

/// How the forces of one kind (F_at, F_ax or F_ay) scatter about the law, relative to hypot(F, floor · mean|F|).
template <typename Scalar>
struct CuttingScatter {
    Scalar robust_sd{0};  ///< of the cuts without the odd ones (Huber's proposal 2).
    Scalar rms{0};        ///< of all cuts.
    Scalar floor_N{0};    ///< floor · mean|F|
    int cuts{0};
    int odd_cuts{0};  ///< beyond the Huber limit by three more standard deviations.
};

template <typename Scalar>
struct CuttingFit {
    /// With its doubts filled in: variance of the coefficients and scatter of single cuts together.
    CuttingLaw<Scalar> law{};
    Eigen::Matrix<Scalar, cutting_parameter_count, 1> parameters =
        Eigen::Matrix<Scalar, cutting_parameter_count, 1>::Zero();
    Eigen::Matrix<Scalar, cutting_parameter_count, cutting_parameter_count> covariance =
        Eigen::Matrix<Scalar, cutting_parameter_count, cutting_parameter_count>::Zero();
    Scalar reference_chip_thickness_mm{0};
    Scalar minimum_feed_per_tooth_mm{0};
    Scalar maximum_feed_per_tooth_mm{0};
    CuttingScatter<Scalar> tangential{}, feed{}, normal{};
    unsigned undetermined{0};  ///< bit j: these cuts cannot determine parameter j; `law` is then not to be used.
    bool converged = false;

    bool determined(int j) const { return ((undetermined >> static_cast<unsigned>(j)) & 1U) == 0U; }
    Scalar standard_error(int j) const {
        using std::sqrt;
        return sqrt(covariance(j, j));
    }
    /// Standard errors of the coefficients at t = 1 mm, as the law holds them.
    Scalar k_s_standard_error() const { return at_one_mm(cutting_ln_K_s, cutting_p_s, law.k_s_N_per_mm2); }
    Scalar k_1_standard_error() const;

  private:
    Scalar at_one_mm(int level, int exponent, Scalar value) const {
        using std::log;
        using std::sqrt;
        const Scalar x = -log(reference_chip_thickness_mm);
        return value * sqrt(covariance(level, level) + x * x * covariance(exponent, exponent) +
                            2 * x * covariance(level, exponent));
    }
};

template <typename Scalar>
Scalar CuttingFit<Scalar>::k_1_standard_error() const {
    using std::exp;
    using std::log;
    using std::sqrt;
    const Scalar x = -log(reference_chip_thickness_mm);
    const Scalar to_one_mm = exp(x * parameters(cutting_p_1));
    const Scalar by_exponent = x * parameters(cutting_r_1);
    return to_one_mm * sqrt(covariance(cutting_r_1, cutting_r_1) +
                            by_exponent * by_exponent * covariance(cutting_p_1, cutting_p_1) +
                            2 * by_exponent * covariance(cutting_r_1, cutting_p_1));
}

/// Fits the cuts; see above. Cuts with no engagement, no feed or non-finite geometry are left out.
///
/// `undetermined` names what is missing: K_te, K_re and the exponents with one feed per tooth only; K_s without a
/// finite force; r_1, p_1 and K_re where only torques were measured, or normal forces in slots alone (s = 0 there). The
/// cuts are read some 40 times. No heap.
template <typename Scalar>
CuttingFit<Scalar> fit_cutting_law(std::span<const CuttingMeasurement<Scalar>> cuts,
                                   const CuttingFitOptions<Scalar>& options = {});

}  // namespace millforce::estimation

#include "estimation_calibration/detail/cutting_fit_solver.hpp"
