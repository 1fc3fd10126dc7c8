// SPDX-License-Identifier: Apache-2.0
#include "loop/ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <random>
#include <thread>

#include "loop/override_source.hpp"

namespace millforce::sim {

namespace {

RunFigures run_one(Scenario scenario, std::uint64_t seed, const EnsembleSettings& settings) {
    scenario.seed = seed;
    scenario.deviation = drawn_deviation(scenario, seed);
    SimulationSettings simulation;
    simulation.longest_run_s = settings.longest_run_s;
    if (settings.map) {
        MappedController controller(scenario.parameters, *settings.map);
        return simulate(scenario, controller, "millforce", simulation).result.figures;
    }
    MillforceController controller(scenario.parameters);
    return simulate(scenario, controller, "millforce", simulation).result.figures;
}

/// Root of the mean square, and mean, over the runs that have a value.
struct Pool {
    double sum = 0.0;
    double sum_of_squares = 0.0;
    int count = 0;

    void add(double value) {
        if (std::isfinite(value)) {
            sum += value;
            sum_of_squares += value * value;
            ++count;
        }
    }
    [[nodiscard]] double mean() const { return count > 0 ? sum / count : host::no_estimate; }
    [[nodiscard]] double rms() const { return count > 0 ? std::sqrt(sum_of_squares / count) : host::no_estimate; }
};

/// The value that this share of them does not exceed. 0 < share < 1, and there is at least one value.
double quantile(std::vector<double> values, double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

}  // namespace

PlantDeviation drawn_deviation(const Scenario& scenario, std::uint64_t seed) {
    std::seed_seq mixed{seed, std::uint64_t{0x9e3779b9}};
    std::mt19937_64 random(mixed);
    std::normal_distribution<double> normal;
    const auto& machine = scenario.parameters.machine;
    PlantDeviation deviation = scenario.deviation;
    const estimation::CuttingLaw<float>& law = scenario.parameters.tool.law;
    const auto drawn = [&](float sd) { return static_cast<double>(sd) * normal(random); };
    const auto scale = [&](float sd) { return std::clamp(1.0 + drawn(sd), 0.1, 3.0); };
    deviation.cutting_force_scale *= std::exp(drawn(law.K_s_relative_sd));
    deviation.radial_force_scale *= std::exp(drawn(law.r_1_relative_sd));
    deviation.size_effect_shift = drawn(law.K_s_exponent_sd);
    deviation.radial_size_effect_shift = drawn(law.r_1_exponent_sd);
    deviation.size_effect_pivot_mm = std::max(static_cast<double>(law.reference_chip_thickness_mm), 1e-3);
    deviation.friction_scale *= scale(machine.axes[0].friction_relative_sd);
    deviation.spindle_gain_scale *= scale(machine.spindle.gain_relative_sd);
    deviation.axis_gain_scale *= scale(machine.axes[0].gain_relative_sd);
    return deviation;
}

std::vector<RunFigures> run_ensemble(const Scenario& scenario, int runs, const std::function<bool(double)>& progress,
                                     const EnsembleSettings& settings) {
    const int workers = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    std::vector<RunFigures> figures;
    while (static_cast<int>(figures.size()) < runs) {
        const int first = static_cast<int>(figures.size());
        std::vector<std::future<RunFigures>> batch;
        for (int k = first; k < std::min(runs, first + workers); ++k) {
            const std::uint64_t seed = scenario.seed + static_cast<std::uint64_t>(k);
            batch.push_back(std::async(std::launch::async, run_one, scenario, seed, std::cref(settings)));
        }
        for (std::future<RunFigures>& run : batch) {
            figures.push_back(run.get());
        }
        if (progress && !progress(static_cast<double>(figures.size()) / runs)) {
            break;
        }
    }
    return figures;
}

EnsembleFigures summarise_ensemble(const std::vector<RunFigures>& runs) {
    EnsembleFigures all;
    Pool time, tangential, feed_force, share, immersion, immersion_coverage, depth_share, depth, depth_coverage;
    std::vector<double> peaks;
    for (const RunFigures& run : runs) {
        ++all.runs;
        all.unfinished += run.finished ? 0 : 1;
        all.teeth_broken += run.teeth_broken;
        all.late_over_limit_s_worst = std::max(all.late_over_limit_s_worst, run.late_over_limit_s);
        peaks.push_back(run.peak_over_limit);
        time.add(run.time_s);
        tangential.add(run.tangential_error);
        feed_force.add(run.feed_force_error);
        share.add(run.estimate_share);
        immersion.add(run.immersion_rms);
        immersion_coverage.add(run.immersion_coverage);
        depth_share.add(run.depth_share);
        depth.add(run.depth_rms_mm);
        depth_coverage.add(run.depth_coverage);
    }
    if (peaks.empty()) {
        return all;
    }
    all.peak_over_limit_median = quantile(peaks, 0.5);
    all.peak_over_limit_95 = quantile(peaks, 0.95);
    all.peak_over_limit_worst = *std::max_element(peaks.begin(), peaks.end());
    all.time_s_mean = time.mean();
    all.tangential_error = tangential.rms();
    all.feed_force_error = feed_force.rms();
    all.estimate_share = share.mean();
    all.immersion_rms = immersion.rms();
    all.immersion_coverage = immersion_coverage.mean();
    all.depth_share = depth_share.mean();
    all.depth_rms_mm = depth.rms();
    all.depth_coverage = depth_coverage.mean();
    return all;
}

}  // namespace millforce::sim
