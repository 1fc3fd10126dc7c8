// SPDX-License-Identifier: Apache-2.0
#include "check/motion_windows.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

constexpr double window_s = 0.2;
constexpr double largest_gap_s = 0.1;
constexpr std::size_t fewest_samples = 5;

}  // namespace

bool AxisWindow::is_at_rest() const {
    constexpr double creep_mm_s = 0.02;
    constexpr double noise_mm_s = 2.0;  // from the smallest to the largest velocity
    return is_present && std::abs(velocity_mm_s) < creep_mm_s && fastest_mm_s - slowest_mm_s < noise_mm_s;
}

bool AxisWindow::is_steady() const {
    constexpr double steady_share = 0.1;
    return is_present && fastest_mm_s * slowest_mm_s > 0.0 &&
           fastest_mm_s - slowest_mm_s < steady_share * std::abs(velocity_mm_s);
}

double MotionWindow::spindle_rad_s() const {
    return turned_rev * estimation::turn_rad<double> / duration_s;
}

bool MotionWindow::turns_steadily() const {
    constexpr double steady_share = 0.02;
    return turns() && std::abs(spindle_acceleration_rad_s2) * duration_s < steady_share * spindle_rad_s();
}

double MotionWindow::speed_mm_s() const {
    double squares = 0.0;
    for (const AxisWindow& axis : axes) {
        squares += axis.is_present ? axis.velocity_mm_s * axis.velocity_mm_s : 0.0;
    }
    return std::sqrt(squares);
}

bool MotionWindow::moves() const {
    return std::any_of(axes.begin(), axes.end(), [](const AxisWindow& axis) { return axis.is_steady(); });
}

bool MotionWindow::is_at_rest() const {
    return std::any_of(axes.begin(), axes.end(), [](const AxisWindow& axis) { return axis.is_present; }) &&
           std::all_of(axes.begin(), axes.end(),
                       [](const AxisWindow& axis) { return !axis.is_present || axis.is_at_rest(); });
}

MotionWindows::MotionWindows(std::uint32_t encoder_counts_per_rev)
    : counts_per_rev_(static_cast<double>(encoder_counts_per_rev)) {
    begin(0.0);
}

void MotionWindows::begin(double time_s) {
    window_ = {};
    window_.start_s = time_s;
    window_.has_spindle_current = true;
    for (AxisWindow& axis : window_.axes) {
        axis.is_present = true;
    }
    first_half_rev_ = first_half_s_ = 0.0;
}

void MotionWindows::add(double time_s, const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const bool has_count = (sample.present & hal::mask(hal::Present::spindle_count)) != 0;
    if (!has_last_ || !has_count || time_s - last_s_ > largest_gap_s) {
        begin(time_s);
    } else {
        window_.turned_rev += static_cast<std::int32_t>(sample.spindle_count - last_count_) / counts_per_rev_;
    }
    has_last_ = has_count;
    last_count_ = sample.spindle_count;
    last_s_ = time_s;
    ++window_.samples;
    window_.has_spindle_current =
        window_.has_spindle_current && (sample.present & hal::mask(hal::Present::spindle_current)) != 0;
    window_.spindle_current_A += static_cast<double>(sample.spindle_current_A);
    window_.is_rapid = (window_.samples == 1 || window_.is_rapid) && program.rapid;
    const auto commanded_rad_s = static_cast<double>(program.commanded_speed_rad_s);
    const bool is_commanded_as_before = window_.samples == 1 || commanded_rad_s == window_.commanded_rad_s;
    window_.commanded_rad_s = is_commanded_as_before ? commanded_rad_s : 0.0;
    window_.programmed_feed_mm_s =
        std::max(window_.programmed_feed_mm_s, static_cast<double>(program.programmed_feed_mm_s));
    add_axes(sample);
    if (first_half_s_ == 0.0 && time_s - window_.start_s >= 0.5 * window_s) {
        first_half_rev_ = window_.turned_rev;
        first_half_s_ = time_s - window_.start_s;
    }
    if (time_s - window_.start_s >= window_s) {
        close(time_s);
    }
}

void MotionWindows::add_axes(const hal::DriveSample& sample) {
    for (std::size_t k = 0; k < window_.axes.size(); ++k) {
        AxisWindow& axis = window_.axes[k];
        const auto velocity_mm_s = static_cast<double>(sample.axis_velocity_mm_s[k]);
        axis.is_present = axis.is_present && (sample.present & hal::axis_mask(k)) != 0;
        axis.current_A += static_cast<double>(sample.axis_current_A[k]);
        axis.velocity_mm_s += velocity_mm_s;
        axis.slowest_mm_s = std::min(axis.slowest_mm_s, velocity_mm_s);
        axis.fastest_mm_s = std::max(axis.fastest_mm_s, velocity_mm_s);
    }
}

void MotionWindows::close(double end_s) {
    window_.duration_s = end_s - window_.start_s;
    const double second_half_s = window_.duration_s - first_half_s_;
    if (window_.samples >= fewest_samples && second_half_s > 0.0) {
        const double count = static_cast<double>(window_.samples);
        window_.spindle_current_A /= count;
        for (AxisWindow& axis : window_.axes) {
            axis.current_A /= count;
            axis.velocity_mm_s /= count;
        }
        const double faster_rev_s =
            (window_.turned_rev - first_half_rev_) / second_half_s - first_half_rev_ / first_half_s_;
        window_.spindle_acceleration_rad_s2 = faster_rev_s * estimation::turn_rad<double> / (0.5 * window_.duration_s);
        windows_.push_back(window_);
    }
    begin(end_s);
}

}  // namespace millforce::host
