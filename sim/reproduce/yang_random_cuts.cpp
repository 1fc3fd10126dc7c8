// SPDX-License-Identifier: Apache-2.0
#include "reproduce/yang_random_cuts.hpp"

#include <algorithm>
#include <limits>
#include <random>

#include "reproduce/yang_measurement.hpp"

namespace millforce::sim::yang {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

class RandomCut {
  public:
    explicit RandomCut(std::uint64_t seed) : random_(seed) {}

    double between(double low, double high) { return low + (high - low) * uniform_(random_); }

    /// A nominal cut: any mill, any material, any depths the twelve categories need.
    SteadyCut nominal(double largest_runout_in_feeds) {
        SteadyCut cut;
        cut.cutter.teeth = static_cast<std::size_t>(between(2.0, 6.999));
        cut.cutter.diameter_mm = between(6.0, 20.0);
        cut.cutter.helix_rad = between(20.0, 50.0) * degree;
        cut.feed_per_tooth_mm = cut.cutter.diameter_mm * between(0.003, 0.008);
        cut.cutter.runout_mm = cut.feed_per_tooth_mm * between(0.0, largest_runout_in_feeds);
        cut.cutter.runout_angle_rad = between(0.0, turn);
        cut.up_milling = between(0.0, 1.0) < 0.5;
        cut.tip_angle_rad = between(0.0, turn);
        const double radius_mm = 0.5 * cut.cutter.diameter_mm;
        cut.axial_depth_mm = radius_mm * between(0.2, 3.0);
        cut.radial_depth_mm = radius_mm * between(0.1, 1.8);
        cut.coefficients = material();
        return cut;
    }

    /// The same mill in another piece: other depths, other hardness.
    SteadyCut varied(const SteadyCut& nominal) {
        constexpr double largest_variation = 0.5;
        constexpr double widest_in_diameters = 0.99;
        SteadyCut cut = nominal;
        cut.axial_depth_mm *= 1.0 + between(-largest_variation, largest_variation);
        cut.radial_depth_mm = std::min(cut.radial_depth_mm * (1.0 + between(-largest_variation, largest_variation)),
                                       widest_in_diameters * cut.cutter.diameter_mm);
        cut.coefficients = material();
        return cut;
    }

    ForceSensor sensor(std::size_t teeth) {
        ForceSensor sensor;
        sensor.spindle_speed_rev_s = between(10.0, 100.0);
        sensor.samples_per_revolution = 540;
        sensor.low_pass_Hz = 7.0 * static_cast<double>(teeth) * sensor.spindle_speed_rev_s;  // the paper's rule
        sensor.plane_only = true;
        sensor.seed = random_();
        return sensor;
    }

  private:
    CuttingCoefficients material() {
        CuttingCoefficients K;
        K.K_tc_N_mm2 = between(800.0, 3500.0);
        K.K_rc_N_mm2 = K.K_tc_N_mm2 * between(0.2, 0.5);
        K.K_te_N_mm = K.K_tc_N_mm2 * between(0.0, 0.015);
        K.K_re_N_mm = K.K_te_N_mm * between(0.5, 1.5);
        const double exponent = between(-0.3, 0.0);
        K.size_effect = {exponent, exponent, exponent, 0.03, 1e-3};
        return K;
    }

    std::mt19937_64 random_;
    std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

std::vector<ForceSample> record_of(const SteadyCut& cut, const ForceSensor& sensor) {
    return record_force(force_revolution(cut, sensor.samples_per_revolution), sensor, profile_revolutions);
}

std::size_t category_of(const SteadyCut& cut) {
    const auto category = estimation::cut_category(estimation::flute_angles(geometry_of(cut.cutter), depths_of(cut)));
    return 4 * static_cast<std::size_t>(category.type) + static_cast<std::size_t>(category.overlap);
}

RandomCutOutcome one_cut(RandomCut& draw, const RandomCutOptions& options) {
    const SteadyCut nominal = draw.nominal(options.largest_runout_in_feeds);
    const SteadyCut cut = draw.varied(nominal);
    ForceSensor sensor = draw.sensor(nominal.cutter.teeth);
    estimation::DepthMonitor<float> monitor(fit_settings(nominal, sensor), profile_revolutions);
    if (options.tip_angle_known) {
        feed(record_of(nominal, sensor), sensor, monitor);
        monitor.learn_tip_angle(depths_of(nominal));
        ++sensor.seed;
    }
    feed(record_of(cut, sensor), sensor, monitor);
    const auto estimate = monitor.evaluate();
    const auto error = [](const estimation::Measurement<float>& m, double truth_mm) {
        return m.valid ? static_cast<double>(m.value) - truth_mm : std::numeric_limits<double>::quiet_NaN();
    };
    const double axial_mm = error(estimate.axial_depth_mm, cut.axial_depth_mm);
    const double radial_mm = error(estimate.radial_depth_mm, cut.radial_depth_mm);
    return {.axial_error_percent = 100.0 * axial_mm / nominal.axial_depth_mm,
            .radial_error_percent = 100.0 * radial_mm / nominal.radial_depth_mm,
            .axial_error_in_sd = axial_mm / std::sqrt(static_cast<double>(estimate.axial_depth_mm.variance)),
            .radial_error_in_sd = radial_mm / std::sqrt(static_cast<double>(estimate.radial_depth_mm.variance)),
            .up_milling = cut.up_milling,
            .category = category_of(cut)};
}

bool answered(const RandomCutOutcome& outcome) {
    return std::isfinite(outcome.axial_error_percent) && std::isfinite(outcome.radial_error_percent);
}

double larger_error_percent(const RandomCutOutcome& outcome) {
    return answered(outcome) ? std::max(std::abs(outcome.axial_error_percent), std::abs(outcome.radial_error_percent))
                             : infinity;
}

template <typename Choice>
double percentile_95(const std::vector<RandomCutOutcome>& outcomes, const Choice& chosen) {
    std::vector<double> errors;
    for (const RandomCutOutcome& outcome : outcomes) {
        if (chosen(outcome)) {
            errors.push_back(larger_error_percent(outcome));
        }
    }
    if (errors.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(errors.begin(), errors.end());
    return errors[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(errors.size()))) - 1];
}

}  // namespace

std::vector<RandomCutOutcome> random_cuts(const RandomCutOptions& options) {
    RandomCut draw(options.seed);
    std::vector<RandomCutOutcome> outcomes;
    outcomes.reserve(options.count);
    for (std::size_t i = 0; i < options.count; ++i) {
        outcomes.push_back(one_cut(draw, options));
    }
    return outcomes;
}

RandomCutSummary summary_of(const std::vector<RandomCutOutcome>& outcomes) {
    RandomCutSummary all{};
    std::array<bool, 12> occurs{};
    double sum_percent = 0.0;
    double within = 0.0;
    double count = 0.0;
    for (const RandomCutOutcome& outcome : outcomes) {
        occurs[outcome.category] = true;
        if (!answered(outcome)) {
            continue;
        }
        count += 1.0;
        sum_percent += std::abs(outcome.axial_error_percent) + std::abs(outcome.radial_error_percent);
        within += (std::abs(outcome.axial_error_in_sd) <= 2.0 ? 0.5 : 0.0) +
                  (std::abs(outcome.radial_error_in_sd) <= 2.0 ? 0.5 : 0.0);
        all.largest_answered_percent = std::max(all.largest_answered_percent, larger_error_percent(outcome));
    }
    all.mean_error_percent = 0.5 * sum_percent / count;
    all.within_two_sd_share = within / count;
    all.answered_share = count / static_cast<double>(outcomes.size());
    all.percentile_95_percent = percentile_95(outcomes, [](const RandomCutOutcome&) { return true; });
    all.percentile_95_up_percent = percentile_95(outcomes, [](const RandomCutOutcome& o) { return o.up_milling; });
    all.percentile_95_down_percent = percentile_95(outcomes, [](const RandomCutOutcome& o) { return !o.up_milling; });
    all.categories = static_cast<std::size_t>(std::count(occurs.begin(), occurs.end(), true));
    return all;
}

}  // namespace millforce::sim::yang
