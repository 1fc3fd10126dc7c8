// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cutting/cutting_force.hpp"
#include "cutting/engagement_map.hpp"
#include "machine/force_sensor.hpp"

/// The bench of Hwang et al., section 3.1: a face mill with carbide inserts, a dynamometer behind a 300 Hz low-pass,
/// and an encoder that triggers 512 samples per revolution. The force is the plant's (sim/cutting); nothing here knows
/// the estimator.

namespace millforce::sim {

/// A workpiece material under coated carbide inserts whose edges are rounded by 70–80 µm (section 3.2).
struct BenchMaterial {
    const char* name = "";
    CuttingCoefficients coefficients{};
};
[[nodiscard]] BenchMaterial steel_SM45C();
[[nodiscard]] BenchMaterial aluminium_6061();

struct BenchCut {
    double spindle_speed_rpm = 300.0;
    double diameter_mm = 100.0;
    double feed_per_tooth_mm = 0.15;
    int teeth = 3;
    double axial_depth_mm = 1.5;
    BenchMaterial material{};
    bool up_milling = true;
    double immersion = 0.5;
    double runout_mm = 0.008;  ///< eccentricity: the inserts' radii differ by up to twice that
    double runout_angle_rad = 0.7;
};

/// What happens between the force and the sample. Pressure varies along the cut like an inhomogeneous workpiece, with
/// the correlation length of a tooth pitch.
struct BenchChain {
    ForceSensorSettings sensor{.low_pass_hz = 300.0};
    double pressure_variation = 0.02;
    std::uint64_t seed = 1;
};

/// One sample as the estimator gets it.
struct BenchSample {
    double angle_rev = 0.0;  ///< 0…1
    double dt_s = 0.0;
    double fx_N = 0.0;
    double fy_N = 0.0;
    double immersion = 0.0;  ///< true, of this moment
};

inline constexpr int bench_samples_per_rev = 512;

[[nodiscard]] Cutter bench_cutter(const BenchCut& cut);
[[nodiscard]] EngagementMap bench_engagement(const BenchCut& cut, double immersion);

/// Samples of a cut that lasts, the filter settled. The immersion may change: `immersion_at(revolutions)`.
[[nodiscard]] std::vector<BenchSample> bench_samples(const BenchCut& cut, const BenchChain& chain, double revolutions);
[[nodiscard]] std::vector<BenchSample> bench_samples(const BenchCut& cut, const BenchChain& chain, double revolutions,
                                                     const std::function<double(double)>& immersion_at);

}  // namespace millforce::sim
