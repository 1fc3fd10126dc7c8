// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/cutting/cutting_law.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <Eigen/Core>

#include <cmath>

/// What a force drop and the average forces say about the cut, at an immersion that is tried.
///
/// Hwang et al. take F_t = K a f_z sin φ and F_r = r F_t (Eqs. 1, 2). Here edge forces are added to the chip's:
///
///   F_t(φ) = K a (f_z sin φ + e_t),   F_r(φ) = K a (r f_z sin φ + e_r),   e_t = K_te/K_tc,  e_r = K_re/K_tc
///
/// e_t and e_r are lengths (mm): the feed at which edge and chip weigh the same. Relative to the chip's force they
/// depend neither on the depth of cut nor on the diameter or the number of teeth, so that calibration serves all of
/// these. e = 0 is the paper's law.
///
/// At the angle φ_j where teeth jump, one tooth's force is the jump; turned into the tooth's directions it gives K a
/// and r there. The averages over a pitch give K a and r_av for the same immersion, by two linear equations:
///
///   2π/N F_aX = K a (f_z s + e_t d + e_r c) + K a r_av f_z b
///   2π/N F_aY = K a (−f_z b − e_t c + e_r d) + K a r_av f_z s              (c, s, b, d: cutting_law.hpp)
///
/// With e = 0 and φ_st = 0 their quotient is Eq. 11 of the paper, rearranged. Two relations close the problem:
///
///   r = a r_av + b                                   (Eq. 12)
///   ln(K/K_av) = c_0 + c_1 (1 − immersion) + c_2 ln(f_z/0.15 mm)
///
/// the second is ours: the chip at the jump is not the mean chip, and thin chips cost more.

namespace millforce::estimation {

/// Calibrated constants of a tool and a workpiece material. To be stored with the tool.
template <typename Scalar>
struct ForceDropLaw {
    bool valid = false;
    Scalar e_t_mm{0};
    Scalar e_r_mm{0};
    Scalar e_t_sd_mm{0};
    Scalar e_r_sd_mm{0};

    Scalar a{1};  ///< Eq. 12; the paper's is 0.50465, and depends on the tool
    Scalar b{0};  ///< Eq. 12; the paper prints none
    Eigen::Matrix<Scalar, 2, 2> a_b_covariance = Eigen::Matrix<Scalar, 2, 2>::Zero();
    Scalar r_scatter{0};  ///< standard deviation of r about the line, cut from cut
    Scalar r_av_mean{0};  ///< over the calibration cuts, and how r_av varied among them
    Scalar r_av_sd{0};

    Eigen::Matrix<Scalar, 3, 1> c = Eigen::Matrix<Scalar, 3, 1>::Zero();  ///< c_0, c_1, c_2
    Eigen::Matrix<Scalar, 3, 3> c_covariance = Eigen::Matrix<Scalar, 3, 3>::Zero();
    Scalar ln_K_scatter{0};

    /// The other edge of the cut, where the chip is nothing: jump and growth of the force there, per K a and per K a
    /// f_z. With e_t and e_r alone they would be e_t, e_r, 1 ± e_r/f_z and r ∓ e_t/f_z; thin chips and runout change
    /// them.
    Scalar other_step_x_mm{0};
    Scalar other_step_y_mm{0};
    Scalar other_slope_x{0};  ///< per radian; counted positive for up milling, with the opposite sign for down milling
    Scalar other_slope_y{0};

    Scalar smallest_immersion{literal<Scalar>(0.1L)};  ///< calibrated range, widened a little: no estimate outside
    Scalar largest_immersion{0};                       ///< 0: not calibrated
};

/// The middle of usual feeds per tooth: from it a material's c_0 and c_2 hardly depend on each other.
template <typename Scalar>
inline constexpr Scalar pressure_reference_feed_mm = literal<Scalar>(0.15L);

/// What c multiplies.
template <typename Scalar>
Eigen::Matrix<Scalar, 3, 1> pressure_regressors(Scalar one_minus_immersion, Scalar feed_per_tooth_mm) {
    using elementary::log;
    return {Scalar(1), one_minus_immersion, log(feed_per_tooth_mm / pressure_reference_feed_mm<Scalar>)};
}

/// Jump and averages of one tooth period, as tooth force: positive where teeth push.
template <typename Scalar>
struct ForceDropMeasurement {
    Measurement<Scalar> tooth_x_N{};  ///< force of a tooth where it jumps: dF_X, dF_Y of Eqs. 15–18
    Measurement<Scalar> tooth_y_N{};
    Measurement<Scalar> mean_x_N{};  ///< F_aX, F_aY of Eqs. 8, 9
    Measurement<Scalar> mean_y_N{};
    Scalar feed_per_tooth_mm{0};
    Scalar teeth{1};
    CutSide side = CutSide::up;

    bool has_other_edge = false;  ///< measured only where the immersion is known: in calibration
    Scalar other_step_x_N{0};
    Scalar other_step_y_N{0};
    Scalar other_slope_x_N_per_rad{0};
    Scalar other_slope_y_N_per_rad{0};
};

/// Where a tooth jumps from or to its largest force: it leaves an up cut, it enters a down cut.
template <typename Scalar>
Scalar jump_angle_rad(CutSide side, EngagementAngles<Scalar> engagement) {
    return side == CutSide::up ? engagement.exit_rad : engagement.entry_rad;
}

/// The six numbers that the equations take.
template <typename Scalar>
struct ForceDropInputs {
    Scalar tooth_x_N{0};
    Scalar tooth_y_N{0};
    Scalar mean_x_N{0};
    Scalar mean_y_N{0};
    Scalar e_t_mm{0};
    Scalar e_r_mm{0};
};

/// Cutting pressure and force ratio, at the jump and on average, if the engagement were this one.
template <typename Scalar>
struct ForceDropRatios {
    bool possible = false;             ///< both pressures are positive
    Scalar pressure_N_per_mm{0};       ///< K a at the jump
    Scalar r{0};                       ///< r at the jump
    Scalar mean_pressure_N_per_mm{0};  ///< K a on average
    Scalar r_av{0};
    Scalar r_av_per_x{0};  ///< ∂r_av/∂F_aX, per N
    Scalar r_av_per_y{0};
};

template <typename Scalar>
ForceDropRatios<Scalar> force_drop_ratios(const ForceDropInputs<Scalar>& in, Scalar feed_per_tooth_mm, Scalar teeth,
                                          CutSide side, EngagementAngles<Scalar> engagement) {
    using elementary::cos;
    using elementary::sin;
    ForceDropRatios<Scalar> ratios;
    const Scalar phi = jump_angle_rad(side, engagement);
    const Scalar sine = sin(phi);
    const Scalar cosine = cos(phi);
    const Scalar chip_mm = feed_per_tooth_mm * sine;
    const Scalar tangential_N = in.tooth_x_N * cosine - in.tooth_y_N * sine;
    const Scalar radial_N = in.tooth_x_N * sine + in.tooth_y_N * cosine;

    const EngagementIntegrals<Scalar> i = engagement_integrals(engagement);
    const Scalar per_tooth = Scalar(2) * pi<Scalar> / teeth;
    const Scalar x = in.mean_x_N * per_tooth;
    const Scalar y = in.mean_y_N * per_tooth;
    const Scalar f = feed_per_tooth_mm;
    const Scalar x_of_K = f * i.s + in.e_t_mm * i.d + in.e_r_mm * i.c;
    const Scalar y_of_K = -f * i.b - in.e_t_mm * i.c + in.e_r_mm * i.d;
    const Scalar determinant = (x_of_K * i.s - y_of_K * i.b) * f;
    if (!(chip_mm > Scalar(0)) || !(determinant > Scalar(0))) {
        return ratios;
    }
    ratios.pressure_N_per_mm = tangential_N / (chip_mm + in.e_t_mm);
    ratios.mean_pressure_N_per_mm = (x * i.s - y * i.b) * f / determinant;
    ratios.possible = ratios.pressure_N_per_mm > Scalar(0) && ratios.mean_pressure_N_per_mm > Scalar(0);
    if (ratios.possible) {
        ratios.r = (radial_N / ratios.pressure_N_per_mm - in.e_r_mm) / chip_mm;
        const Scalar scale = Scalar(1) / (determinant * ratios.mean_pressure_N_per_mm);
        ratios.r_av = (y * x_of_K - x * y_of_K) * scale;
        ratios.r_av_per_x = -(y_of_K + ratios.r_av * i.s * f) * scale * per_tooth;
        ratios.r_av_per_y = (x_of_K + ratios.r_av * i.b * f) * scale * per_tooth;
    }
    return ratios;
}

}  // namespace millforce::estimation
