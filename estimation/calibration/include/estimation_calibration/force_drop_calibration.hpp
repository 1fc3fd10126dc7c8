// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/force_drop/force_drop_law.hpp"
#include "estimation/number/least_squares.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// e_t, e_r, a, b and c of a ForceDropLaw from cuts of known immersion, depth and feed.
///
/// First the edge lengths: jump and average of each cut are linear in K_tc, K_te, K_rc, K_re, four rows a cut,
///
///   tooth_x = a_p [K_tc f sin φ cos φ + K_te cos φ + K_rc f sin² φ + K_re sin φ]      at the jump, and for tooth_y
///   2π/N F_aX = a_p [K_tc f s + K_te d + K_rc f b + K_re c]                           and for F_aY
///
/// weighted by 1/(standard deviation, and 2 % of the force for what the linear law leaves out). Then r and r_av of each
/// cut with the edges taken out, and a line through them for a and b; ln K/K_av for c. Slopes that the cuts do not
/// determine are put at their neutral value (a = 1, c_1 = c_2 = 0) and the height alone is fitted: so cuts of one
/// immersion calibrate, too.
///
/// Last the jump at the other edge, per K a, as the mean over the cuts that measured it.
///
/// The feeds must differ by a factor of 1.5 at least, else chip and edge cannot be told apart: `edges_determined` is
/// false and the law not valid. `without_edges`: e = 0, the paper's own law, from the same cuts.
/// Memory: 11 scalars per cut. Cost of solve(): 4 · MaxCuts rows of least squares in 4 unknowns. Not thread-safe.

namespace millforce::estimation {

template <typename Scalar>
struct ForceDropCalibrationCut {
    ForceDropMeasurement<Scalar> measured{};
    Scalar axial_depth_mm{0};
    Scalar radial_immersion{0};
};

template <typename Scalar>
struct ForceDropCalibrationResult {
    ForceDropLaw<Scalar> law{};
    bool edges_determined = false;
    bool a_determined = false;                       ///< false: a = 1 was put
    bool c_determined = false;                       ///< false: c_1 = c_2 = 0 were put
    LeastSquaresSolution<Scalar, 4> coefficients{};  ///< K_tc, K_te, K_rc, K_re (N/mm², N/mm)
    int cuts = 0;
};

template <typename Scalar, int MaxCuts = 64>
class ForceDropCalibration {
  public:
    using Cut = ForceDropCalibrationCut<Scalar>;
    using Result = ForceDropCalibrationResult<Scalar>;

    /// False: the cut is left out, for want of room or of a valid measurement.
    bool add(const Cut& cut) {
        const auto& m = cut.measured;
        const bool usable = m.tooth_x_N.valid && m.tooth_y_N.valid && m.mean_x_N.valid && m.mean_y_N.valid &&
                            m.feed_per_tooth_mm > Scalar(0) && cut.axial_depth_mm > Scalar(0) &&
                            cut.radial_immersion > Scalar(0) && cut.radial_immersion < Scalar(1) &&
                            (m.side == CutSide::up || m.side == CutSide::down);
        if (!usable || count_ >= MaxCuts) {
            return false;
        }
        cuts_[static_cast<std::size_t>(count_)] = cut;
        ++count_;
        return true;
    }

    [[nodiscard]] Result solve() const {
        using std::sqrt;
        Result result;
        result.cuts = count_;
        fit_edges(result);
        if (!result.edges_determined) {
            return result;
        }
        const auto& k = result.coefficients;
        const Scalar K_tc = k.parameters(0);
        result.law.e_t_mm = k.parameters(1) / K_tc;
        result.law.e_r_mm = k.parameters(3) / K_tc;
        result.law.e_t_sd_mm = ratio_sd(k, 1, result.law.e_t_mm);
        result.law.e_r_sd_mm = ratio_sd(k, 3, result.law.e_r_mm);
        fit_lines(result);
        average_other_edge(result);
        return result;
    }

    [[nodiscard]] Result solve_without_edges() const {
        Result result;
        result.cuts = count_;
        fit_lines(result);
        return result;
    }

  private:
    using Row4 = Eigen::Matrix<Scalar, 4, 1>;
    using Row2 = Eigen::Matrix<Scalar, 2, 1>;
    static constexpr Scalar law_share = static_cast<Scalar>(0.02L);

    void fit_edges(Result& result) const {
        using std::cos;
        using std::sin;
        LeastSquares<Scalar, 4> fit;
        Scalar least_feed_mm = Scalar(1e6F);
        Scalar largest_feed_mm{0};
        for (int n = 0; n < count_; ++n) {
            const Cut& cut = cuts_[static_cast<std::size_t>(n)];
            const auto& m = cut.measured;
            const Scalar f = m.feed_per_tooth_mm;
            const EngagementAngles<Scalar> engagement = engagement_angles(m.side, cut.radial_immersion);
            const Scalar phi = jump_angle_rad(m.side, engagement);
            const Scalar s = sin(phi);
            const Scalar c = cos(phi);
            const EngagementIntegrals<Scalar> i = engagement_integrals(engagement);
            const Scalar depth = cut.axial_depth_mm;
            const Scalar per_pitch = depth * m.teeth / (Scalar(2) * pi<Scalar>);
            add_row(fit, Row4(f * s * c, c, f * s * s, s) * depth, m.tooth_x_N, size(m.tooth_x_N, m.tooth_y_N));
            add_row(fit, Row4(-f * s * s, -s, f * s * c, c) * depth, m.tooth_y_N, size(m.tooth_x_N, m.tooth_y_N));
            add_row(fit, Row4(f * i.s, i.d, f * i.b, i.c) * per_pitch, m.mean_x_N, size(m.mean_x_N, m.mean_y_N));
            add_row(fit, Row4(-f * i.b, -i.c, f * i.s, i.d) * per_pitch, m.mean_y_N, size(m.mean_x_N, m.mean_y_N));
            least_feed_mm = f < least_feed_mm ? f : least_feed_mm;
            largest_feed_mm = f > largest_feed_mm ? f : largest_feed_mm;
        }
        result.coefficients = fit.solve();
        result.edges_determined = count_ >= 3 && largest_feed_mm >= Scalar(1.5F) * least_feed_mm &&
                                  result.coefficients.undetermined == 0U &&
                                  result.coefficients.parameters(0) > Scalar(0);
    }

    static Scalar size(const Measurement<Scalar>& x, const Measurement<Scalar>& y) {
        using std::sqrt;
        return sqrt(square(x.value) + square(y.value));
    }

    static void add_row(LeastSquares<Scalar, 4>& fit, const Row4& regressors, const Measurement<Scalar>& force,
                        Scalar size_N) {
        using std::sqrt;
        fit.add(regressors, force.value, Scalar(1) / sqrt(force.variance + square(law_share * size_N)));
    }

    /// Of K_j/K_tc, their covariance counted.
    static Scalar ratio_sd(const LeastSquaresSolution<Scalar, 4>& k, int j, Scalar ratio) {
        using std::sqrt;
        const Scalar variance =
            k.covariance(j, j) + square(ratio) * k.covariance(0, 0) - Scalar(2) * ratio * k.covariance(0, j);
        return sqrt(variance > Scalar(0) ? variance : Scalar(0)) / k.parameters(0);
    }

    void fit_lines(Result& result) const {
        using std::log;
        LeastSquares<Scalar, 2> ratio;
        LeastSquares<Scalar, 1> ratio_height;
        LeastSquares<Scalar, 3> pressure;
        LeastSquares<Scalar, 1> pressure_height;
        using Row1 = Eigen::Matrix<Scalar, 1, 1>;
        LeastSquares<Scalar, 1> r_av;
        Scalar smallest = Scalar(1);
        Scalar largest{0};
        for (int n = 0; n < count_; ++n) {
            const Cut& cut = cuts_[static_cast<std::size_t>(n)];
            const ForceDropRatios<Scalar> at = ratios_of(cut, result.law);
            if (!at.possible) {
                continue;
            }
            const Scalar ln_K = log(at.pressure_N_per_mm / at.mean_pressure_N_per_mm);
            ratio.add(Row2(at.r_av, Scalar(1)), at.r);
            ratio_height.add(Row1(Scalar(1)), at.r - at.r_av);
            r_av.add(Row1(Scalar(1)), at.r_av);
            pressure.add(pressure_regressors(Scalar(1) - cut.radial_immersion, cut.measured.feed_per_tooth_mm), ln_K);
            pressure_height.add(Row1(Scalar(1)), ln_K);
            smallest = cut.radial_immersion < smallest ? cut.radial_immersion : smallest;
            largest = cut.radial_immersion > largest ? cut.radial_immersion : largest;
        }
        const auto mean_r_av = r_av.solve();
        result.law.r_av_mean = mean_r_av.parameters(0);
        result.law.r_av_sd = mean_r_av.residual_sd;
        take_ratio_line(ratio, ratio_height, result);
        take_pressure_line(pressure, pressure_height, result);
        constexpr Scalar beyond = static_cast<Scalar>(0.1L);
        result.law.smallest_immersion = clamp(smallest - beyond, static_cast<Scalar>(0.1L), Scalar(1));
        result.law.largest_immersion = clamp(largest + beyond, Scalar(0), static_cast<Scalar>(0.95L));
        result.law.valid = result.law.valid && ratio_height.rows() > 2;
    }

    static void take_ratio_line(const LeastSquares<Scalar, 2>& sloped, const LeastSquares<Scalar, 1>& level,
                                Result& result) {
        constexpr Scalar least_significance = Scalar(2);
        ForceDropLaw<Scalar>& law = result.law;
        const auto line = sloped.solve();
        result.a_determined =
            line.undetermined == 0U && sloped.rows() > 3 &&
            square(line.parameters(0) - Scalar(1)) > square(least_significance) * line.covariance(0, 0);
        if (result.a_determined) {
            law.a = line.parameters(0);
            law.b = line.parameters(1);
            law.a_b_covariance = line.covariance;
            law.r_scatter = line.residual_sd;
            law.valid = true;
            return;
        }
        const auto height = level.solve();
        law.a = Scalar(1);
        law.b = height.parameters(0);
        law.a_b_covariance.setZero();
        law.a_b_covariance(1, 1) = height.covariance(0, 0);
        law.r_scatter = height.residual_sd;
        law.valid = height.undetermined == 0U;
    }

    static void take_pressure_line(const LeastSquares<Scalar, 3>& sloped, const LeastSquares<Scalar, 1>& level,
                                   Result& result) {
        ForceDropLaw<Scalar>& law = result.law;
        const auto plane = sloped.solve();
        result.c_determined = plane.undetermined == 0U && sloped.rows() > 4;
        if (result.c_determined) {
            law.c = plane.parameters;
            law.c_covariance = plane.covariance;
            law.ln_K_scatter = plane.residual_sd;
            return;
        }
        const auto height = level.solve();
        law.c = {height.parameters(0), Scalar(0), Scalar(0)};
        law.c_covariance.setZero();
        law.c_covariance(0, 0) = height.covariance(0, 0);
        law.ln_K_scatter = height.residual_sd;
    }

    void average_other_edge(Result& result) const {
        ForceDropLaw<Scalar>& law = result.law;
        int measured = 0;
        for (int n = 0; n < count_; ++n) {
            const Cut& cut = cuts_[static_cast<std::size_t>(n)];
            const auto& m = cut.measured;
            const ForceDropRatios<Scalar> at = ratios_of(cut, law);
            if (!m.has_other_edge || !at.possible) {
                continue;
            }
            const Scalar pressure = at.pressure_N_per_mm;
            const Scalar chip_N = (m.side == CutSide::up ? Scalar(1) : Scalar(-1)) * pressure * m.feed_per_tooth_mm;
            ++measured;
            const Scalar share = Scalar(1) / Scalar(measured);
            law.other_step_x_mm += (m.other_step_x_N / pressure - law.other_step_x_mm) * share;
            law.other_step_y_mm += (m.other_step_y_N / pressure - law.other_step_y_mm) * share;
            law.other_slope_x += (m.other_slope_x_N_per_rad / chip_N - law.other_slope_x) * share;
            law.other_slope_y += (m.other_slope_y_N_per_rad / chip_N - law.other_slope_y) * share;
        }
    }

    static ForceDropRatios<Scalar> ratios_of(const Cut& cut, const ForceDropLaw<Scalar>& law) {
        const auto& m = cut.measured;
        const ForceDropInputs<Scalar> in{m.tooth_x_N.value, m.tooth_y_N.value, m.mean_x_N.value,
                                         m.mean_y_N.value,  law.e_t_mm,        law.e_r_mm};
        return force_drop_ratios(in, m.feed_per_tooth_mm, m.teeth, m.side,
                                 engagement_angles(m.side, cut.radial_immersion));
    }

    std::array<Cut, static_cast<std::size_t>(MaxCuts)> cuts_{};
    int count_ = 0;
};

}  // namespace millforce::estimation
