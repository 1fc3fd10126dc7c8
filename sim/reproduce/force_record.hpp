// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cutting/cutter.hpp"
#include "cutting/cutting_coefficients.hpp"

/// What a dynamometer under the workpiece records of a steady cut: the plant's force, through the amplifier's low-pass,
/// with noise, sampled. The plant repeats itself every revolution; filter and noise do not.

namespace millforce::sim {

struct SteadyCut {
    Cutter cutter{};
    CuttingCoefficients coefficients{};
    double feed_per_tooth_mm = 0.05;
    double axial_depth_mm = 1.0;
    double radial_depth_mm = 1.0;
    bool up_milling = false;
    double tip_angle_rad = 0.0;  ///< angle of tooth 0 at the encoder's zero
};

struct ForceSensor {
    double spindle_speed_rev_s = 1000.0 / 60.0;
    int samples_per_revolution = 4320;
    double low_pass_Hz = 470.0;  ///< two poles, Butterworth; 0: none
    double noise_share = 0.01;   ///< white, standard deviation over the largest plane force, after the filter
    bool plane_only = false;     ///< fz_N and scalar_sum_N of a record stay as the plant gives them
    std::uint64_t seed = 1;
};

/// One sample, and what no sensor measures: the sum of the single flutes' forces as if they added as scalars.
struct ForceSample {
    double fx_N = 0.0;
    double fy_N = 0.0;
    double fz_N = 0.0;
    double scalar_sum_N = 0.0;
};

/// One noiseless revolution, unfiltered, from the encoder's zero on.
[[nodiscard]] std::vector<ForceSample> force_revolution(const SteadyCut& cut, int samples_per_revolution);

/// `revolutions` and a few samples more, after one revolution in which the filter settles. Deterministic per seed.
[[nodiscard]] std::vector<ForceSample> record_force(const std::vector<ForceSample>& revolution,
                                                    const ForceSensor& sensor, int revolutions);

}  // namespace millforce::sim
