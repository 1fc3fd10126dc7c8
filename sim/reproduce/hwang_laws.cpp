// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_laws.hpp"

#include "estimation/cutting/cut_geometry.hpp"

namespace millforce::sim {

namespace {

double a_without_edges(const BenchMaterial& material) {
    return calibration_of(calibration_cuts(material, true, hwang_seed)).solve_without_edges().law.a;
}

}  // namespace

HwangLaws calibrated_laws() {
    HwangLaws laws;
    laws.steel_cuts = calibration_cuts(steel_SM45C(), true, hwang_seed);
    const estimation::ForceDropCalibration steel = calibration_of(laws.steel_cuts);
    const estimation::ForceDropCalibration aluminium =
        calibration_of(calibration_cuts(aluminium_6061(), true, hwang_seed));
    laws.steel = steel.solve();
    laws.steel_without_edges = steel.solve_without_edges();
    laws.aluminium = aluminium.solve();
    laws.aluminium_without_edges = aluminium.solve_without_edges();
    laws.steel_down = calibration_of(calibration_cuts(steel_SM45C(), false, hwang_seed)).solve();
    BenchMaterial other = steel_SM45C();
    other.coefficients.K_te_N_mm *= 2.0;
    BenchMaterial without_size_effect = other;
    without_size_effect.coefficients.size_effect = {};
    laws.a_at_twice_K_te_without_size_effect = a_without_edges(without_size_effect);
    other.coefficients.K_re_N_mm *= 2.0;
    laws.a_at_twice_both_edge_forces = a_without_edges(other);
    return laws;
}

std::vector<ForceRatioPoint> force_ratio_points(const std::vector<estimation::ForceDropCalibrationCut>& cuts) {
    std::vector<ForceRatioPoint> points;
    for (const estimation::ForceDropCalibrationCut& cut : cuts) {
        const auto& m = cut.measured;
        const estimation::ForceDropInputs<double> without_edges{
            m.tooth_x_N.value, m.tooth_y_N.value, m.mean_x_N.value, m.mean_y_N.value, 0.0, 0.0};
        const auto ratios = estimation::force_drop_ratios(without_edges, m.feed_per_tooth_mm, m.teeth, m.side,
                                                          estimation::engagement_angles(m.side, cut.radial_immersion));
        if (ratios.possible) {
            points.push_back({ratios.r_av, ratios.r});
        }
    }
    return points;
}

}  // namespace millforce::sim
