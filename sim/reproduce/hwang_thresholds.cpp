// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_thresholds.hpp"

#include "cutting/revolution_load.hpp"
#include "estimation/cutting/peak_factors.hpp"

namespace millforce::sim {

std::vector<ThresholdPoint> thresholds(const TableResult& row, const BenchCut& row_cut,
                                       const estimation::ForceDropCalibration::Result& calibrated) {
    const auto& k = calibrated.coefficients.parameters;
    const auto in_float = [&k](int j) { return static_cast<float>(k(j)); };
    const auto law = estimation::linear_edge_law(in_float(0), in_float(1), in_float(2), in_float(3));
    estimation::PeakFactorSettings<float> settings;
    settings.teeth = static_cast<float>(row_cut.teeth);
    settings.cutter_radius_mm = static_cast<float>(0.5 * row_cut.diameter_mm);
    settings.nominal_feed_per_tooth_mm = static_cast<float>(row_cut.feed_per_tooth_mm);
    settings.side = estimation::CutSide::up;
    std::vector<ThresholdPoint> points;
    for (const TableCut& milled : row) {
        BenchCut cut = row_cut;
        cut.runout_mm = 0.0;
        const CuttingForce plant(bench_cutter(cut), cut.material.coefficients, {.resolution = {.axial_slices = 6}});
        const RevolutionLoad load =
            revolution_load(plant, cut.feed_per_tooth_mm, bench_engagement(cut, milled.immersion));
        const auto factor_at = [&](double immersion) {
            return static_cast<double>(estimation::peak_factors(law, settings, static_cast<float>(immersion),
                                                                static_cast<float>(cut.axial_depth_mm))
                                           .threshold_factor());
        };
        const double sd = static_cast<double>(milled.runs.back().estimate.radial_immersion_sd);
        points.push_back({milled.immersion, factor_at(milled.mean()), factor_at(milled.mean() - 2.0 * sd),
                          load.peak_total_N / load.peak_tooth_N});
    }
    return points;
}

}  // namespace millforce::sim
