// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "reproduce/hwang_bench.hpp"
#include "reproduce/yang_published.hpp"

namespace millforce::test {

/// A force sensor's sample in the feed's frame.
struct FeedFrameSample {
    double turned_rad;  ///< not wrapped
    double along_N;
    double across_N;
};

/// A recording with a force sensor and without currents, the feed in any direction of the machine's plane.
inline std::string force_recording(const std::vector<FeedFrameSample>& samples, double rate_hz, double feed_mm_s,
                                   double direction_rad) {
    std::ostringstream text;
    text.precision(9);
    text << "time_s,spindle_angle_rad,fx_N,fy_N,x_velocity_mm_s,y_velocity_mm_s\n";
    const double cosine = std::cos(direction_rad);
    const double sine = std::sin(direction_rad);
    double time_s = 0.0;
    for (const FeedFrameSample& s : samples) {
        text << time_s << ',' << s.turned_rad - direction_rad << ',' << cosine * s.along_N - sine * s.across_N << ','
             << sine * s.along_N + cosine * s.across_N << ',' << feed_mm_s * cosine << ',' << feed_mm_s * sine << '\n';
        time_s += 1.0 / rate_hz;
    }
    return text.str();
}

/// The face mill of Hwang et al. at the immersion, up milling SM45C.
inline std::string face_mill_recording(double immersion, double direction_rad, double feed_per_tooth_mm = 0.15) {
    const sim::BenchCut cut{
        .feed_per_tooth_mm = feed_per_tooth_mm, .material = sim::steel_SM45C(), .immersion = immersion};
    const double rev_s = cut.spindle_speed_rpm / 60.0;
    std::vector<FeedFrameSample> samples;
    for (const sim::BenchSample& s : sim::bench_samples(cut, {.seed = 3}, 20.0)) {
        const double turned_rev = static_cast<double>(samples.size()) / sim::bench_samples_per_rev;
        samples.push_back({2.0 * std::numbers::pi * turned_rev, s.fx_N, s.fy_N});
    }
    return force_recording(samples, rev_s * sim::bench_samples_per_rev, cut.feed_per_tooth_mm * cut.teeth * rev_s,
                           direction_rad);
}

/// Mill 1, type I of Yang et al. with axial and radial variation in percent.
inline std::string end_mill_recording(double axial_percent, double radial_percent, double direction_rad) {
    const sim::SteadyCut cut = sim::yang::published_cut(0, 0, {axial_percent, radial_percent});
    sim::ForceSensor sensor;
    sensor.samples_per_revolution = 720;
    const auto revolution = sim::force_revolution(cut, sensor.samples_per_revolution);
    std::vector<FeedFrameSample> samples;
    for (const sim::ForceSample& s : sim::record_force(revolution, sensor, 42)) {
        const double turned_rev = static_cast<double>(samples.size()) / sensor.samples_per_revolution;
        samples.push_back({2.0 * std::numbers::pi * turned_rev, s.fx_N, s.fy_N});
    }
    const double rev_s = sensor.spindle_speed_rev_s;
    return force_recording(samples, rev_s * sensor.samples_per_revolution,
                           cut.feed_per_tooth_mm * static_cast<double>(cut.cutter.teeth) * rev_s, direction_rad);
}

/// The law of that face mill in SM45C, from 21 simulated calibration cuts.
inline const std::string face_mill_tool_text = R"([tool]
teeth = 3
diameter_mm = 100.0
helix_deg = 5.0
flute_length_mm = 3.0
side = "up"
tooth_force_limit_N = 1500.0
[cutting]
k_s_N_per_mm2 = 1750.0
k_1 = 0.4
[control]
entry_feed_per_tooth_mm = 0.1
air_feed_per_tooth_mm = 0.1
max_feed_per_tooth_mm = 0.3
[force_sensor]
low_pass_hz = 300.0
zero_drift_sd_N = 2.0
[force_drop]
e_t_mm = 0.037885
e_r_mm = 0.0368146
e_t_sd_mm = 0.00113345
e_r_sd_mm = 0.000847194
a = -0.911246
b = 0.786266
a_variance = 0.0899348
a_b_covariance = -0.0361748
b_variance = 0.0145602
r_scatter = 0.0140574
r_av_mean = 0.402234
r_av_sd = 0.0104816
c_0 = -0.0159807
c_1 = 0.0548007
c_2 = -0.0504133
c_0_variance = 3.72934e-05
c_0_c_1_covariance = -6.41304e-05
c_0_c_2_covariance = 2.49149e-06
c_1_variance = 0.000128261
c_1_c_2_covariance = -3.27108e-11
c_2_variance = 6.34592e-05
ln_K_scatter = 0.0103797
other_step_x_mm = 0.0194664
other_step_y_mm = 0.0273701
other_slope_x = 1.98454
other_slope_y = 0.423352
smallest_immersion = 0.1
largest_immersion = 0.9
)";

/// Mill 1 of Yang et al. with the nominal depths of type I.
inline const std::string end_mill_tool_text = R"([tool]
teeth = 4
diameter_mm = 19.05
helix_deg = 30.0
flute_length_mm = 40.0
side = "down"
tooth_force_limit_N = 3000.0
[cutting]
k_s_N_per_mm2 = 1800.0
k_1 = 0.35
[control]
entry_feed_per_tooth_mm = 0.0381
air_feed_per_tooth_mm = 0.0381
max_feed_per_tooth_mm = 0.1
[force_sensor]
low_pass_hz = 470.0
[depth_shape]
nominal_axial_depth_mm = 7.62
nominal_radial_width_mm = 7.62
feed_per_tooth_mm = 0.0381
)";

}  // namespace millforce::test
