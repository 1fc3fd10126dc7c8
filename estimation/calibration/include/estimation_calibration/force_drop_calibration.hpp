// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/force_drop/force_drop_law.hpp"
#include "estimation/number/least_squares.hpp"

#include <vector>

/// e_t, e_r, a, b and c of a ForceDropLaw from cuts of known immersion, depth and feed.
///
/// First the edge lengths: jump and average of each cut are linear in K_tc, K_te, K_rc, K_re, four rows a cut,
///
///   tooth_x = a_p [K_tc f sin φ cos φ + K_te cos φ + K_rc f sin² φ + K_re sin φ]      at the jump, and for tooth_y
///   2π/N F_aX = a_p [K_tc f s + K_te d + K_rc f b + K_re c]                           and for F_aY
///
/// weighted by 1/(standard deviation, and 2 % of the force for what the linear law leaves out). Then r and r_av of each
/// cut with the edges taken out, and a line through them for a and b; ln K/K_av for c. Slopes that the cuts do not
/// determine are set to their neutral value (a = 1, c_1 = c_2 = 0) and the height alone is fitted: so cuts of one
/// immersion calibrate, too.
///
/// Last the jump at the other edge, per K a, as the mean over the cuts that measured it.
///
/// The feeds must differ by a factor of 1.5 at least, else chip and edge forces cannot be separated: `edges_determined`
/// is false and the law not valid. Without edges (e = 0) the same cuts give the paper's own law.

namespace millforce::estimation {

struct ForceDropCalibrationCut {
    ForceDropMeasurement<double> measured{};
    double axial_depth_mm = 0.0;
    double radial_immersion = 0.0;
};

struct ForceDropCalibrationResult {
    ForceDropLaw<double> law{};
    bool edges_determined = false;
    bool a_determined = false;                       ///< false: a was set to 1
    bool c_determined = false;                       ///< false: c_1 and c_2 were set to 0
    LeastSquaresSolution<double, 4> coefficients{};  ///< K_tc, K_te, K_rc, K_re (N/mm², N/mm)
    int cuts = 0;
};

class ForceDropCalibration {
  public:
    using Cut = ForceDropCalibrationCut;
    using Result = ForceDropCalibrationResult;

    /// False: the cut is left out, because its measurement is not valid.
    bool add(const Cut& cut);

    [[nodiscard]] Result solve() const;
    [[nodiscard]] Result solve_without_edges() const;

  private:
    std::vector<Cut> cuts_;
};

/// A controller measures and estimates in float: its measurements for the fit, and the fitted law for it.
[[nodiscard]] ForceDropMeasurement<double> in_double(const ForceDropMeasurement<float>& measured);
[[nodiscard]] ForceDropLaw<float> in_float(const ForceDropLaw<double>& law);

}  // namespace millforce::estimation
