#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "cutting/angle_units.hpp"
#include "estimation/depth_monitor.hpp"
#include "estimation/depth_variation.hpp"
#include "reproduce/force_record.hpp"
#include "reproduce/reproduction.hpp"
#include "reproduce/yang_tables.hpp"

/// Depth-of-cut variation from the force's shape (Yang, DeVor & Kapoor): the published tests, by the published method
/// and by the fit of the whole profile, and a thousand cuts drawn at random.

namespace millforce::sim {
namespace {

using estimation::CutSide;
using estimation::DepthsOfCut;
using estimation::ForceIndices;
using estimation::Measurement;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr int revolutions = 20;
constexpr int index_bins = 720;
constexpr std::array<const char*, 3> type_names = {"I", "II", "III"};
using ResultantProfile = estimation::FluteAverage<float, 1, index_bins>;

float single(double value) {
    return static_cast<float>(value);
}

// ---------------------------------------------------------------- recordings

/// The profile of one signal of a record; `signal` makes it of a sample.
template <typename Signal>
ResultantProfile profile_of(const std::vector<ForceSample>& record, const ForceSensor& sensor, std::size_t teeth,
                            const Signal& signal) {
    estimation::FluteProfile<float, 1, index_bins> profile({.teeth = static_cast<int>(teeth), .revolutions = revolutions});
    const double step_rev = 1.0 / sensor.samples_per_revolution;
    for (std::size_t i = 0; i < record.size() && !profile.complete(); ++i) {
        const double angle_rev = static_cast<double>(i % static_cast<std::size_t>(sensor.samples_per_revolution)) * step_rev;
        estimation::FluteProfile<float, 1, index_bins>::Signals value;
        value << single(signal(record[i]));
        profile.add(single(step_rev / sensor.spindle_speed_rev_s), i > 0 ? single(step_rev) : 0.0F, single(angle_rev), value);
    }
    return profile.average();
}

double resultant_N(const ForceSample& sample) {
    return std::hypot(sample.fx_N, sample.fy_N, sample.fz_N);
}

ResultantProfile resultant_of_components(const std::vector<ForceSample>& record, const ForceSensor& sensor, std::size_t teeth) {
    const auto x = profile_of(record, sensor, teeth, [](const ForceSample& s) { return s.fx_N; });
    const auto y = profile_of(record, sensor, teeth, [](const ForceSample& s) { return s.fy_N; });
    const auto z = profile_of(record, sensor, teeth, [](const ForceSample& s) { return s.fz_N; });
    ResultantProfile r = x;
    for (std::size_t b = 0; b < r.mean.size(); ++b) r.mean[b][0] = std::hypot(x.mean[b][0], y.mean[b][0], z.mean[b][0]);
    return r;
}

void feed(const std::vector<ForceSample>& record, const ForceSensor& sensor, estimation::DepthMonitor<float>& monitor) {
    monitor.restart();
    const double step_rev = 1.0 / sensor.samples_per_revolution;
    for (std::size_t i = 0; i < record.size(); ++i) {
        const double angle_rev = static_cast<double>(i % static_cast<std::size_t>(sensor.samples_per_revolution)) * step_rev;
        if (monitor.add(single(step_rev / sensor.spindle_speed_rev_s), single(angle_rev * turn), single(record[i].fx_N),
                        single(record[i].fy_N))) {
            return;
        }
    }
}

estimation::FluteGeometry<float> geometry_of(const Cutter& cutter) {
    return {static_cast<int>(cutter.teeth), single(0.5 * cutter.diameter_mm), single(cutter.helix_rad)};
}

/// A fit around nominal depths: ±55 %, so that a cut at the end of ±50 % is not at the end of the search.
estimation::FluteProfileFitSettings<float> fit_settings(const SteadyCut& nominal, const ForceSensor& sensor) {
    constexpr double reach = 0.55;
    estimation::FluteProfileFitSettings<float> settings;
    settings.cutter = geometry_of(nominal.cutter);
    settings.feed_per_tooth_mm = single(nominal.feed_per_tooth_mm);
    settings.side = nominal.up_milling ? CutSide::up : CutSide::down;
    settings.axial = {single((1.0 - reach) * nominal.axial_depth_mm), single((1.0 + reach) * nominal.axial_depth_mm)};
    settings.radial = {single((1.0 - reach) * nominal.radial_depth_mm),
                       single(std::min((1.0 + reach) * nominal.radial_depth_mm, nominal.cutter.diameter_mm))};
    settings.low_pass = {2, single(sensor.low_pass_Hz)};
    return settings;
}

// ---------------------------------------------------------------- the published tests

/// Steel about as 1018. K_te/K_tc makes the mean pressure grow on thin chips as Kim & Chung measured it in SM45C
/// (exponent −0.26 at 0.012 mm), and is none of the estimator's.
CuttingCoefficients published_steel(double hardness = 1.0) {
    CuttingCoefficients steel;
    steel.K_tc_N_mm2 = 1800.0 * hardness;
    steel.K_rc_N_mm2 = 630.0 * hardness;
    steel.K_ac_N_mm2 = 200.0 * hardness;
    steel.K_te_N_mm = 7.5 * hardness;
    steel.K_re_N_mm = 9.0 * hardness;
    return steel;
}

SteadyCut published_cut(std::size_t mill_index, std::size_t type, double axial_percent, double radial_percent) {
    const YangMill& mill = yang_mills[mill_index];
    SteadyCut cut;
    cut.cutter.teeth = mill.flutes;
    cut.cutter.diameter_mm = mill.diameter_mm;
    cut.cutter.helix_rad = mill.helix_deg * degree;
    cut.cutter.runout_mm = 0.005;
    cut.cutter.runout_angle_rad = 0.7;
    cut.coefficients = published_steel();
    cut.feed_per_tooth_mm = mill.feed_per_tooth_mm;
    cut.axial_depth_mm = mill.nominal_axial_mm[type] * (1.0 + 0.01 * axial_percent);
    cut.radial_depth_mm = mill.nominal_radial_mm[type] * (1.0 + 0.01 * radial_percent);
    cut.tip_angle_rad = 0.3;
    return cut;
}

/// Variations in percent; NaN is "no estimate".
struct Variation {
    double axial = none;
    double radial = none;
};

Variation variation(const estimation::DepthVariation<float>& result) {
    if (!result.valid) {
        return {};
    }
    return {100.0 * static_cast<double>(result.best.axial_variation), 100.0 * static_cast<double>(result.best.radial_variation)};
}

Variation variation(const estimation::FluteProfileEstimate<float>& estimate, const SteadyCut& nominal) {
    const auto percent = [](const Measurement<float>& depth, double nominal_mm) {
        return depth.valid ? 100.0 * (static_cast<double>(depth.value) / nominal_mm - 1.0) : none;
    };
    return {percent(estimate.axial_depth_mm, nominal.axial_depth_mm),
            percent(estimate.radial_depth_mm, nominal.radial_depth_mm)};
}

/// One test, by every method.
struct PublishedTest {
    Variation truth;
    Variation published;
    Variation resultant;         ///< Table 1 as printed, on the measured resultant
    Variation scalar_sum;        ///< Table 1 as printed, on flute forces added as scalars
    Variation scalar_corrected;  ///< III/LO and III/MO by the entry's corner
    Variation fit;               ///< whole profile
    Variation fit_alone;         ///< whole profile, the tip's angle not known
    double peak_angle_formula_deg = none;
    ForceIndices<float> resultant_indices;
};

/// One mill and type: the nominal cut teaches K and the tip's angle, the five tests follow.
struct PublishedSeries {
    std::size_t mill;
    std::size_t type;
    std::array<PublishedTest, 5> tests;
    ResultantProfile nominal_resultant;
    ResultantProfile nominal_scalar_sum;
};

ForceIndices<float> indices_of(const ResultantProfile& profile, std::size_t teeth) {
    constexpr double corner_span_deg = 2.0;
    const auto pitch_rad = single(turn / static_cast<double>(teeth));
    return estimation::ForceIndexFinder<float, 1, index_bins>(profile, pitch_rad, CutSide::down, single(corner_span_deg * degree)).find();
}

/// The published method with K from the nominal cut's own mean.
class PublishedMethod {
  public:
    PublishedMethod(const SteadyCut& nominal, const ResultantProfile& nominal_profile)
        : geometry_(geometry_of(nominal.cutter)),
          nominal_{single(nominal.axial_depth_mm), single(nominal.radial_depth_mm)},
          teeth_(nominal.cutter.teeth),
          nominal_indices_(indices_of(nominal_profile, teeth_)),
          energy_(estimation::specific_energy_N_mm2(nominal_indices_.mean_N, nominal_)) {}

    [[nodiscard]] Variation of(const ResultantProfile& profile, estimation::Characteristics characteristics) const {
        estimation::DepthVariationSettings<float> settings;
        settings.cutter = geometry_;
        settings.nominal = nominal_;
        settings.specific_energy_N_mm2 = energy_;
        settings.characteristics = characteristics;
        auto ix = indices_of(profile, teeth_);
        if (getenv("AG")) ix = estimation::read_against(nominal_indices_, estimation::flute_angles(geometry_, nominal_), ix);
        return variation(estimation::DepthVariationMethod<float>(settings).solve(ix));
    }

  private:
    estimation::FluteGeometry<float> geometry_;
    DepthsOfCut<float> nominal_;
    std::size_t teeth_;
    ForceIndices<float> nominal_indices_;
    float energy_;
};

PublishedSeries published_series(std::size_t mill, std::size_t type) {
    const YangMill& table = yang_mills[mill];
    const SteadyCut nominal = published_cut(mill, type, 0.0, 0.0);
    ForceSensor sensor;
    sensor.seed = 100 * mill + 10 * type;
    PublishedSeries series{.mill = mill, .type = type, .tests = {}, .nominal_resultant = {}, .nominal_scalar_sum = {}};
    const auto scalar_sum_N = [](const ForceSample& sample) { return sample.scalar_sum_N; };
    const auto nominal_record = record_force(force_revolution(nominal, sensor.samples_per_revolution), sensor, revolutions);
    series.nominal_resultant = getenv("CF") ? resultant_of_components(nominal_record, sensor, table.flutes) : profile_of(nominal_record, sensor, table.flutes, resultant_N);
    series.nominal_scalar_sum = profile_of(nominal_record, sensor, table.flutes, scalar_sum_N);
    const PublishedMethod on_resultant(nominal, series.nominal_resultant);
    const PublishedMethod on_scalar_sum(nominal, series.nominal_scalar_sum);
    estimation::DepthMonitor<float> monitor(fit_settings(nominal, sensor), revolutions);
    estimation::DepthMonitor<float> alone = monitor;
    feed(nominal_record, sensor, monitor);
    monitor.learn_tip_angle({single(nominal.axial_depth_mm), single(nominal.radial_depth_mm)});
    for (std::size_t t = 0; t < series.tests.size(); ++t) {
        PublishedTest& test = series.tests[t];
        test.truth = {table.axial_variation_percent[t], table.radial_variation_percent[t]};
        const YangEstimate& printed = yang_estimates[type][mill][t];
        test.published = {printed.axial_percent, printed.radial_percent};
        const SteadyCut cut = published_cut(mill, type, test.truth.axial, test.truth.radial);
        ++sensor.seed;
        const auto record = record_force(force_revolution(cut, sensor.samples_per_revolution), sensor, revolutions);
        const ResultantProfile resultant = getenv("CF") ? resultant_of_components(record, sensor, table.flutes): profile_of(record, sensor, table.flutes, resultant_N);
        const ResultantProfile scalar_sum = profile_of(record, sensor, table.flutes, scalar_sum_N);
        test.resultant_indices = indices_of(resultant, table.flutes);
        test.peak_angle_formula_deg =
            static_cast<double>(estimation::published_peak_angle_rad(estimation::flute_angles<float>(
                geometry_of(cut.cutter), {single(cut.axial_depth_mm), single(cut.radial_depth_mm)}))) / degree;
        test.resultant = on_resultant.of(resultant, estimation::Characteristics::published);
        test.scalar_sum = on_scalar_sum.of(scalar_sum, estimation::Characteristics::published);
        test.scalar_corrected = on_scalar_sum.of(scalar_sum, estimation::Characteristics::corrected);
        feed(record, sensor, monitor);
        test.fit = variation(monitor.evaluate(), nominal);
        feed(record, sensor, alone);
        test.fit_alone = variation(alone.evaluate(), nominal);
    }
    return series;
}

}  // namespace

Reproduction reproduce_yang() {
    Reproduction r{.name = "yang", .title = "Depth-of-cut variation from the shape of the cutting force (Yang, DeVor, Kapoor)", .figures = {}, .plots = {}, .deviations = {}};
    for (std::size_t type = 0; type < 3; ++type) {
        for (std::size_t mill = 0; mill < 2; ++mill) {
            const PublishedSeries s = published_series(mill, type);
            for (std::size_t t = 0; t < 5; ++t) {
                const auto& x = s.tests[t];
                fmt::print("T{} mill {} test {}: truth {:+.0f}/{:+.0f} pub {:+.2f}/{:+.2f} resultant {:+.2f}/{:+.2f} scalar {:+.2f}/{:+.2f} corr {:+.2f}/{:+.2f} fit {:+.2f}/{:+.2f} alone {:+.2f}/{:+.2f}\n", type + 5, mill + 1, t + 1, x.truth.axial, x.truth.radial, x.published.axial - x.truth.axial, x.published.radial - x.truth.radial, x.resultant.axial - x.truth.axial, x.resultant.radial - x.truth.radial, x.scalar_sum.axial - x.truth.axial, x.scalar_sum.radial - x.truth.radial, x.scalar_corrected.axial - x.truth.axial, x.scalar_corrected.radial - x.truth.radial, x.fit.axial - x.truth.axial, x.fit.radial - x.truth.radial, x.fit_alone.axial - x.truth.axial, x.fit_alone.radial - x.truth.radial);
            }
        }
    }
    return r;
}

}  // namespace millforce::sim
