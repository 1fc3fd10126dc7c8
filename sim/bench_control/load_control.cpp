// SPDX-License-Identifier: Apache-2.0
#include "bench_control/load_control.hpp"

#include <algorithm>
#include <cmath>

#include "loop/simulation.hpp"

namespace millforce::sim {

namespace {

constexpr double idle_s = 1.5;  // the spindle turns for two seconds before the program begins
constexpr double smoothing_s = 0.05;

double travel_mm(const hal::DriveSample& sample, double dt_s) {
    const auto squared = [](float value) { return static_cast<double>(value) * static_cast<double>(value); };
    const auto& velocity = sample.axis_velocity_mm_s;
    return std::sqrt(squared(velocity[0]) + squared(velocity[1]) + squared(velocity[2])) * dt_s;
}

}  // namespace

double LoadControl::smoothed_load(double current_A) {
    ++samples_;
    const int idle_samples = static_cast<int>(idle_s * settings_.sample_rate_hz);
    if (samples_ <= idle_samples) {
        idle_sum_A_ += current_A;
        smooth_A_ = idle_sum_A_ / samples_;
        return 0.0;
    }
    smooth_A_ += (current_A - smooth_A_) / (smoothing_s * settings_.sample_rate_hz);
    return (smooth_A_ - idle_sum_A_ / idle_samples) / settings_.rated_current_A;
}

hal::FeedOverride LoadControl::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    LoadView view;
    view.dt_s = 1.0 / settings_.sample_rate_hz;
    view.load = smoothed_load(static_cast<double>(sample.spindle_current_A));
    view.reference = settings_.reference;
    view.travel_mm = travel_mm(sample, view.dt_s);
    largest_load_ = std::max(largest_load_, view.load);
    const double share = rule_->step(view);
    hal::FeedOverride output;
    output.ratio = program.rapid ? 1.0F : static_cast<float>(settings_.feed_ratio * share);
    output.hold = rule_->has_stopped();
    output.fault = rule_->has_stopped() ? static_cast<std::uint8_t>(control::Fault::overload) : std::uint8_t{0};
    return output;
}

LoadControl::Settings load_settings(const Scenario& scenario, double feed_ratio, double reference) {
    const auto& machine = scenario.parameters.machine;
    return {feed_ratio, reference, static_cast<double>(machine.spindle_rated_current_A),
            static_cast<double>(machine.cnc.sample_rate_hz)};
}

TaughtCut taught_cut(const Scenario& scenario, double feed_ratio) {
    LoadControl control(load_settings(scenario, feed_ratio, 0.0), std::make_unique<ConstantRule>());
    const Simulated run = simulate(scenario, control, "teach-in");
    return {control.largest_load(), run.result.figures.time_s};
}

}  // namespace millforce::sim
