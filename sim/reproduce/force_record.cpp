// SPDX-License-Identifier: Apache-2.0
#include "reproduce/force_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "cutting/angle_units.hpp"
#include "cutting/cutting_force.hpp"
#include "machine/butterworth.hpp"

namespace millforce::sim {
namespace {

double largest_plane_force_N(const std::vector<ForceSample>& samples) {
    double largest_N = 0.0;
    for (const ForceSample& sample : samples) {
        largest_N = std::max(largest_N, std::hypot(sample.fx_N, sample.fy_N));
    }
    return largest_N;
}

}  // namespace

std::vector<ForceSample> force_revolution(const SteadyCut& cut, int samples_per_revolution) {
    Cutter cutter = cut.cutter;
    cutter.flute_length_mm = cut.axial_depth_mm;
    const CuttingForce force(cutter, cut.coefficients);
    const double engagement_rad = std::acos(1.0 - cut.radial_depth_mm / (0.5 * cutter.diameter_mm));
    const EngagementMap map =
        cut.up_milling ? uniform_engagement(0.0, engagement_rad, cut.axial_depth_mm)
                       : uniform_engagement(std::numbers::pi - engagement_rad, std::numbers::pi, cut.axial_depth_mm);
    std::vector<ForceSample> samples;
    samples.reserve(static_cast<std::size_t>(samples_per_revolution));
    for (int i = 0; i < samples_per_revolution; ++i) {
        const CuttingLoad load =
            force.load(cut.tip_angle_rad + turn * i / samples_per_revolution, cut.feed_per_tooth_mm, map);
        double scalar_sum_N = 0.0;
        for (const double tooth_N : load.tooth_force_N) {
            scalar_sum_N += tooth_N;
        }
        samples.push_back({load.fx_N, load.fy_N, load.fz_N, scalar_sum_N});
    }
    return samples;
}

std::vector<ForceSample> record_force(const std::vector<ForceSample>& revolution, const ForceSensor& sensor,
                                      int revolutions) {
    constexpr int settling_revolutions = 1;
    constexpr std::size_t more_samples = 8;  // so that rounding never leaves the last revolution open
    const double sampling_Hz = sensor.spindle_speed_rev_s * static_cast<double>(revolution.size());
    std::mt19937_64 random(sensor.seed);
    std::normal_distribution<double> noise_N(0.0, sensor.noise_share * largest_plane_force_N(revolution));
    constexpr std::array<double ForceSample::*, 4> channels = {&ForceSample::fx_N, &ForceSample::fy_N,
                                                               &ForceSample::fz_N, &ForceSample::scalar_sum_N};
    const std::size_t used_channels = sensor.plane_only ? 2 : channels.size();
    const bool filtered = sensor.low_pass_Hz > 0.0;
    std::array<ButterworthFilter, 4> low_pass{
        ButterworthFilter(sensor.low_pass_Hz, sampling_Hz), ButterworthFilter(sensor.low_pass_Hz, sampling_Hz),
        ButterworthFilter(sensor.low_pass_Hz, sampling_Hz), ButterworthFilter(sensor.low_pass_Hz, sampling_Hz)};
    std::vector<ForceSample> record;
    record.reserve(revolution.size() * static_cast<std::size_t>(revolutions) + more_samples);
    const std::size_t settling = revolution.size() * settling_revolutions;
    const std::size_t all = settling + revolution.size() * static_cast<std::size_t>(revolutions) + more_samples;
    for (std::size_t i = 0; i < all; ++i) {
        ForceSample sample = revolution[i % revolution.size()];
        for (std::size_t c = 0; c < used_channels; ++c) {
            double& value = sample.*channels[c];
            value = filtered ? low_pass[c].filter(value) : value;
            value += i >= settling ? noise_N(random) : 0.0;
        }
        if (i >= settling) {
            record.push_back(sample);
        }
    }
    return record;
}

}  // namespace millforce::sim
