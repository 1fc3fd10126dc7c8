// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_bench.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

namespace {

constexpr int force_steps_per_sample = 8;

/// First-order wandering about 1.
class PressureVariation {
  public:
    PressureVariation(const BenchChain& chain, int teeth)
        : sd_(chain.pressure_variation),
          keep_(std::exp(-static_cast<double>(teeth) / (bench_samples_per_rev * force_steps_per_sample))),
          random_(chain.seed * 7919U + 3U) {}
    double step() {
        deviation_ = keep_ * deviation_ + std::sqrt(1.0 - keep_ * keep_) * sd_ * normal_(random_);
        return 1.0 + deviation_;
    }

  private:
    double sd_;
    double keep_;
    double deviation_ = 0.0;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_{0.0, 1.0};
};

struct PlanarForce {
    double x_N = 0.0;
    double y_N = 0.0;
};

using ForceAt = std::function<PlanarForce(long step)>;

std::vector<BenchSample> sampled(const BenchCut& cut, const BenchChain& chain, double revolutions,
                                 const ForceAt& force_at, const std::function<double(double)>& immersion_at) {
    constexpr long steps_per_rev = static_cast<long>(bench_samples_per_rev) * force_steps_per_sample;
    const double revs_per_s = cut.spindle_speed_rpm / 60.0;
    ForceChannel x(chain.sensor, static_cast<double>(steps_per_rev) * revs_per_s, chain.seed * 2U);
    ForceChannel y(chain.sensor, static_cast<double>(steps_per_rev) * revs_per_s, chain.seed * 2U + 1U);
    PressureVariation pressure(chain, cut.teeth);
    std::vector<BenchSample> samples;
    samples.reserve(static_cast<std::size_t>(revolutions * bench_samples_per_rev) + 1);
    const long end = std::lround(revolutions * static_cast<double>(steps_per_rev));
    for (long step = -steps_per_rev; step < end; ++step) {  // one revolution to settle
        const PlanarForce force = force_at(step);
        const double factor = pressure.step();
        x.step(force.x_N * factor);
        y.step(force.y_N * factor);
        if (step >= 0 && step % force_steps_per_sample == 0) {
            const double revs = static_cast<double>(step) / static_cast<double>(steps_per_rev);
            samples.push_back({revs - std::floor(revs), 1.0 / (revs_per_s * bench_samples_per_rev), x.reading_N(),
                               y.reading_N(), immersion_at(revs)});
        }
    }
    return samples;
}

double angle_of(long step) {
    return static_cast<double>(step) / (bench_samples_per_rev * force_steps_per_sample) * turn;
}

}  // namespace

BenchMaterial steel_SM45C() {
    return {
        .name = "SM45C",
        .coefficients = {
            .K_tc_N_mm2 = 1750.0,
            .K_rc_N_mm2 = 700.0,
            .K_ac_N_mm2 = 150.0,
            .K_te_N_mm = 40.0,
            .K_re_N_mm = 50.0,
            .K_ae_N_mm = 5.0,
            .size_effect = {
                .tangential_exponent = -0.15, .radial_exponent = -0.25, .axial_exponent = -0.15, .reference_mm = 0.1}}};
}

BenchMaterial aluminium_6061() {
    return {
        .name = "Al 6061",
        .coefficients = {
            .K_tc_N_mm2 = 800.0,
            .K_rc_N_mm2 = 240.0,
            .K_ac_N_mm2 = 60.0,
            .K_te_N_mm = 16.0,
            .K_re_N_mm = 18.0,
            .K_ae_N_mm = 2.0,
            .size_effect = {
                .tangential_exponent = -0.12, .radial_exponent = -0.2, .axial_exponent = -0.12, .reference_mm = 0.1}}};
}

Cutter bench_cutter(const BenchCut& cut) {
    return {.type = CutterType::face_mill,
            .teeth = static_cast<std::size_t>(cut.teeth),
            .diameter_mm = cut.diameter_mm,
            .flute_length_mm = 3.0,
            .helix_rad = 5.0 * degree,
            .lead_angle_rad = 75.0 * degree,
            .runout_mm = cut.runout_mm,
            .runout_angle_rad = cut.runout_angle_rad};
}

EngagementMap bench_engagement(const BenchCut& cut, double immersion) {
    const double theta = std::acos(1.0 - immersion);
    return cut.up_milling ? uniform_engagement(0.0, theta, cut.axial_depth_mm)
                          : uniform_engagement(std::numbers::pi - theta, std::numbers::pi, cut.axial_depth_mm);
}

std::vector<BenchSample> bench_samples(const BenchCut& cut, const BenchChain& chain, double revolutions) {
    constexpr long steps_per_rev = static_cast<long>(bench_samples_per_rev) * force_steps_per_sample;
    const CuttingForce plant(bench_cutter(cut), cut.material.coefficients, {.resolution = {.axial_slices = 6}});
    const EngagementMap map = bench_engagement(cut, cut.immersion);
    std::vector<PlanarForce> one_rev(static_cast<std::size_t>(steps_per_rev));
    for (long step = 0; step < steps_per_rev; ++step) {
        const CuttingLoad load = plant.load(angle_of(step), cut.feed_per_tooth_mm, map);
        one_rev[static_cast<std::size_t>(step)] = {load.fx_N, load.fy_N};
    }
    const auto force_at = [&](long step) {
        return one_rev[static_cast<std::size_t>((step + steps_per_rev) % steps_per_rev)];
    };
    return sampled(cut, chain, revolutions, force_at, [&](double) { return cut.immersion; });
}

std::vector<BenchSample> bench_samples(const BenchCut& cut, const BenchChain& chain, double revolutions,
                                       const std::function<double(double)>& immersion_at) {
    const CuttingForce plant(bench_cutter(cut), cut.material.coefficients, {.resolution = {.axial_slices = 6}});
    EngagementMap map{};
    const auto force_at = [&](long step) {
        const double revs = angle_of(step) / turn;
        if (step % force_steps_per_sample == 0) {
            map = bench_engagement(cut, immersion_at(revs));
        }
        const CuttingLoad load = plant.load(angle_of(step), cut.feed_per_tooth_mm, map);
        return PlanarForce{load.fx_N, load.fy_N};
    };
    return sampled(cut, chain, revolutions, force_at, immersion_at);
}

}  // namespace millforce::sim
