// SPDX-License-Identifier: Apache-2.0
#include "reproduce/yang_published.hpp"

#include "reproduce/yang_tables.hpp"

namespace millforce::sim::yang {
namespace {

using estimation::Characteristics;
using estimation::ForceIndices;

/// Steel about as 1018. K_te/K_tc makes the mean pressure grow on thin chips as Kim & Chung measured it in SM45C
/// (exponent −0.26 at 0.012 mm). None of it is known to the estimators.
CuttingCoefficients steel_1018(double hardness) {
    CuttingCoefficients steel;
    steel.K_tc_N_mm2 = 1800.0 * hardness;
    steel.K_rc_N_mm2 = 630.0 * hardness;
    steel.K_ac_N_mm2 = 200.0 * hardness;
    steel.K_te_N_mm = 7.5 * hardness;
    steel.K_re_N_mm = 9.0 * hardness;
    return steel;
}

Variation percent(const estimation::DepthVariation<float>& result) {
    if (!result.valid) {
        return {};
    }
    return {100.0 * static_cast<double>(result.best.axial_variation),
            100.0 * static_cast<double>(result.best.radial_variation)};
}

Variation percent(const estimation::FluteProfileEstimate<float>& estimate, const SteadyCut& nominal) {
    const auto of = [](const estimation::Measurement<float>& depth, double nominal_mm) {
        return depth.valid ? 100.0 * (static_cast<double>(depth.value) / nominal_mm - 1.0)
                           : std::numeric_limits<double>::quiet_NaN();
    };
    return {of(estimate.axial_depth_mm, nominal.axial_depth_mm), of(estimate.radial_depth_mm, nominal.radial_depth_mm)};
}

/// The published method with K, and if wanted the angle's offset, from the nominal cut.
class IndexMethod {
  public:
    IndexMethod(const SteadyCut& nominal, const ForceIndices<float>& nominal_indices)
        : nominal_angles_(estimation::flute_angles(geometry_of(nominal.cutter), depths_of(nominal))),
          nominal_indices_(nominal_indices) {
        settings_.cutter = geometry_of(nominal.cutter);
        settings_.nominal = depths_of(nominal);
        settings_.specific_energy_N_mm2 = estimation::specific_energy_N_mm2(nominal_indices.mean_N, settings_.nominal);
    }
    [[nodiscard]] Variation solve(const ForceIndices<float>& indices, Characteristics characteristics) const {
        auto settings = settings_;
        settings.characteristics = characteristics;
        return percent(estimation::DepthVariationMethod<float>(settings).solve(indices));
    }
    [[nodiscard]] Variation solve_against_nominal(const ForceIndices<float>& indices) const {
        return solve(estimation::read_against(nominal_indices_, nominal_angles_, indices), Characteristics::published);
    }

  private:
    estimation::DepthVariationSettings<float> settings_;
    estimation::FluteAngles<float> nominal_angles_;
    ForceIndices<float> nominal_indices_;
};

struct Measured {
    std::vector<ForceSample> record;
    ForceIndices<float> resultant;
    ForceIndices<float> scalar_sum;
};

Measured measure(const SteadyCut& cut, const ForceSensor& sensor) {
    Measured measured;
    measured.record = record_force(force_revolution(cut, sensor.samples_per_revolution), sensor, profile_revolutions);
    const std::size_t teeth = cut.cutter.teeth;
    measured.resultant = indices_of(flute_average(measured.record, sensor, teeth, resultant_N), teeth);
    measured.scalar_sum = indices_of(flute_average(measured.record, sensor, teeth, scalar_sum_N), teeth);
    return measured;
}

/// What all methods learn from the nominal cut.
class Methods {
  public:
    Methods(const SteadyCut& nominal, const Measured& measured, const ForceSensor& sensor)
        : nominal_(nominal),
          on_resultant_(nominal, measured.resultant),
          on_scalar_sum_(nominal, measured.scalar_sum),
          monitor_(fit_settings(nominal, sensor), profile_revolutions),
          alone_(monitor_) {
        feed(measured.record, sensor, monitor_);
        monitor_.learn_tip_angle(depths_of(nominal));
    }
    void estimate(const Measured& measured, const ForceSensor& sensor, Test& test) {
        test.estimate[printed_on_vectors] = on_resultant_.solve(measured.resultant, Characteristics::published);
        test.estimate[against_nominal] = on_resultant_.solve_against_nominal(measured.resultant);
        test.estimate[printed_on_scalars] = on_scalar_sum_.solve(measured.scalar_sum, Characteristics::published);
        test.estimate[corrected_on_scalars] = on_scalar_sum_.solve(measured.scalar_sum, Characteristics::corrected);
        feed(measured.record, sensor, monitor_);
        test.estimate[profile_fit] = percent(monitor_.evaluate(), nominal_);
        feed(measured.record, sensor, alone_);
        test.estimate[profile_fit_alone] = percent(alone_.evaluate(), nominal_);
    }

  private:
    SteadyCut nominal_;
    IndexMethod on_resultant_;
    IndexMethod on_scalar_sum_;
    estimation::DepthMonitor<float> monitor_;
    estimation::DepthMonitor<float> alone_;
};

}  // namespace

estimation::ForceIndices<float> indices_of(const IndexProfile& profile, std::size_t teeth) {
    constexpr double corner_span_rad = 2.0 * degree;
    const auto pitch_rad = single(turn / static_cast<double>(teeth));
    return estimation::ForceIndexFinder<float, 1, index_bins>(profile, pitch_rad, estimation::CutSide::down,
                                                              single(corner_span_rad))
        .find();
}

SteadyCut published_cut(std::size_t mill_index, std::size_t type, const Variation& variation, double hardness) {
    const YangMill& mill = yang_mills[mill_index];
    SteadyCut cut;
    cut.cutter.teeth = mill.flutes;
    cut.cutter.diameter_mm = mill.diameter_mm;
    cut.cutter.helix_rad = mill.helix_deg * degree;
    cut.cutter.runout_mm = 0.005;  // 10 µm on a dial gauge; the paper gives none
    cut.cutter.runout_angle_rad = 0.7;
    cut.coefficients = steel_1018(hardness);
    cut.feed_per_tooth_mm = mill.feed_per_tooth_mm;
    cut.axial_depth_mm = mill.nominal_axial_mm[type] * (1.0 + 0.01 * variation.axial);
    cut.radial_depth_mm = mill.nominal_radial_mm[type] * (1.0 + 0.01 * variation.radial);
    cut.tip_angle_rad = 0.3;
    return cut;
}

Series published_series(std::size_t mill, std::size_t type) {
    const YangMill& table = yang_mills[mill];
    const SteadyCut nominal = published_cut(mill, type, {0.0, 0.0});
    ForceSensor sensor;
    sensor.seed = 100 * mill + 10 * type;
    const Measured nominal_cut = measure(nominal, sensor);
    Methods methods(nominal, nominal_cut, sensor);
    Series series{.mill = mill, .type = type};
    series.nominal_indices = nominal_cut.resultant;
    series.nominal_formula_rad = static_cast<double>(estimation::published_peak_angle_rad(
        estimation::flute_angles(geometry_of(nominal.cutter), depths_of(nominal))));
    for (std::size_t t = 0; t < series.tests.size(); ++t) {
        Test& test = series.tests[t];
        test.truth = {table.axial_variation_percent[t], table.radial_variation_percent[t]};
        const YangEstimate& printed = yang_estimates[type][mill][t];
        test.estimate[as_published] = {printed.axial_percent, printed.radial_percent};
        ++sensor.seed;
        methods.estimate(measure(published_cut(mill, type, test.truth), sensor), sensor, test);
    }
    return series;
}

TestIndices test_indices(std::size_t mill, std::size_t type, std::size_t test) {
    const YangMill& table = yang_mills[mill];
    const SteadyCut nominal = published_cut(mill, type, {0.0, 0.0});
    ForceSensor sensor;
    const auto nominal_indices = measure(nominal, sensor).resultant;
    ++sensor.seed;
    const SteadyCut cut =
        published_cut(mill, type, {table.axial_variation_percent[test], table.radial_variation_percent[test]});
    const auto angles = estimation::flute_angles(geometry_of(nominal.cutter), depths_of(nominal));
    const auto indices = estimation::read_against(nominal_indices, angles, measure(cut, sensor).resultant);
    const auto PT_doc = estimation::index_of<float>(estimation::cut_category(angles));
    return {static_cast<double>(indices.*PT_doc) / degree, static_cast<double>(indices.mean_N)};
}

HardnessEffect hardness_effect() {
    const SteadyCut nominal = published_cut(0, 0, {0.0, 0.0});
    const ForceSensor sensor;
    Methods methods(nominal, measure(nominal, sensor), sensor);
    constexpr double harder = 1.2;
    const Variation variation{20.0, 15.0};
    Test soft;
    Test hard;
    methods.estimate(measure(published_cut(0, 0, variation), sensor), sensor, soft);
    methods.estimate(measure(published_cut(0, 0, variation, harder), sensor), sensor, hard);
    const auto moved = [&](Method method) {
        return Variation{hard.estimate[method].axial - soft.estimate[method].axial,
                         hard.estimate[method].radial - soft.estimate[method].radial};
    };
    return {moved(against_nominal), moved(profile_fit)};
}

}  // namespace millforce::sim::yang
