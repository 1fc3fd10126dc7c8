// SPDX-License-Identifier: Apache-2.0
#include "check/recorded_units.hpp"

#include "calibration/plausible_units.hpp"
#include "check/drive_keys.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace millforce::host {

namespace {

bool is_feed_move(const MotionWindow& window) {
    return window.moves() && window.turns() && !window.is_rapid;
}

/// The feed move with the median speed.
std::optional<MotionWindow> median_feed_move(std::span<const MotionWindow> windows) {
    std::vector<MotionWindow> feeds;
    std::copy_if(windows.begin(), windows.end(), std::back_inserter(feeds), is_feed_move);
    if (feeds.empty()) {
        return std::nullopt;
    }
    const auto middle = feeds.begin() + static_cast<std::ptrdiff_t>(feeds.size() / 2);
    std::nth_element(feeds.begin(), middle, feeds.end(),
                     [](const MotionWindow& a, const MotionWindow& b) { return a.speed_mm_s() < b.speed_mm_s(); });
    return *middle;
}

std::size_t fastest_axis(const MotionWindow& window) {
    const auto speed = [](const AxisWindow& axis) { return axis.is_present ? std::abs(axis.velocity_mm_s) : 0.0; };
    const auto fastest = std::max_element(window.axes.begin(), window.axes.end(),
                                          [&](const auto& a, const auto& b) { return speed(a) < speed(b); });
    return static_cast<std::size_t>(fastest - window.axes.begin());
}

Findings check_cut(const std::string& name, const MotionWindow& window, const std::string& column,
                   const firmware::ToolParameters<float>& tool) {
    const double teeth_per_s = tool.teeth * window.turned_rev / window.duration_s;
    const CutKinematics cut{static_cast<double>(tool.diameter_mm), window.speed_mm_s(),
                            window.speed_mm_s() / teeth_per_s, window.spindle_rad_s()};
    try {
        refuse_implausible_cut(name, cut, column, "spindle_angle_rad");
    } catch (const InputError& refusal) {
        return {{Severity::error, refusal.what(), column}};
    }
    return {};
}

/// The recorded feed over F; 0 where F is not recorded.
double median_ratio_to_program(std::span<const MotionWindow> windows) {
    std::vector<double> ratios;
    for (const MotionWindow& window : windows) {
        if (is_feed_move(window) && window.programmed_feed_mm_s > 0.0) {
            ratios.push_back(window.speed_mm_s() / window.programmed_feed_mm_s);
        }
    }
    if (ratios.empty()) {
        return 0.0;
    }
    return median_of(std::move(ratios));
}

Findings check_program(std::span<const MotionWindow> windows, const std::string& velocity_column,
                       const firmware::CncParameters<float>& cnc) {
    constexpr double margin = 1.5;
    constexpr double slowest = 0.05;
    const double ratio = median_ratio_to_program(windows);
    if (ratio > margin * static_cast<double>(cnc.override_max)) {
        return {
            {Severity::error,
             fmt::format("the feed is {:.3g} times the programmed one, expected at most override_max = {:g}; is the "
                         "velocity in mm/min?",
                         ratio, cnc.override_max),
             velocity_column}};
    }
    if (ratio > 0.0 && ratio < std::min(slowest, 0.5 * static_cast<double>(cnc.override_min))) {
        return {{Severity::error,
                 fmt::format("the feed is {:.3g} times the programmed one; is programmed_feed_mm_s in mm/min?", ratio),
                 "programmed_feed_mm_s"}};
    }
    return {};
}

/// The rate that the controller is given, for the estimates' windows.
Findings check_rate(std::span<const MotionWindow> windows, const firmware::CncParameters<float>& cnc) {
    constexpr double same_rate = 0.05;
    double samples = 0.0;
    double duration_s = 0.0;
    for (const MotionWindow& window : windows) {
        samples += static_cast<double>(window.samples);
        duration_s += window.duration_s;
    }
    const double rate_hz = samples / duration_s;
    const double stated_hz = static_cast<double>(cnc.sample_rate_hz);
    if (std::abs(rate_hz / stated_hz - 1.0) <= same_rate) {
        return {};
    }
    return {{Severity::note,
             fmt::format("the recording has {:.4g} samples per second, and the machine's file says {:g}", rate_hz,
                         stated_hz),
             "cnc.sample_rate_hz"}};
}

Findings check_floors(const MotionWindow& feed, const firmware::MachineParameters<float>& machine) {
    const std::size_t axis = fastest_axis(feed);
    const auto& parameters = machine.axes.at(axis);
    const double floor_mm_s = static_cast<double>(parameters.velocity_floor_mm_s);
    if (!(parameters.K_x4_N_per_A > 0.0F) || feed.speed_mm_s() >= floor_mm_s) {
        return {};
    }
    return {{Severity::warning,
             fmt::format("{}: no force below {:g} mm/s, and the feed of the recording is {:.3g} mm/s",
                         drive_names.at(axis + 1), floor_mm_s, feed.speed_mm_s()),
             fmt::format("{}.velocity_floor_mm_s", drive_names.at(axis + 1))}};
}

}  // namespace

Findings check_motion(const std::string& name, std::span<const MotionWindow> windows,
                      const firmware::Parameters<float>& parameters) {
    const auto feed = median_feed_move(windows);
    Findings findings = check_rate(windows, parameters.machine.cnc);
    if (!feed) {
        findings.push_back(
            {Severity::note, "no feed with the spindle turning: the feed is not judged", "x_velocity_mm_s"});
        return findings;
    }
    const std::string column = fmt::format("{}_velocity_mm_s", drive_names.at(fastest_axis(*feed) + 1));
    Findings of_feed = check_cut(name, *feed, column, parameters.tool);
    append(findings, of_feed.empty() ? check_program(windows, column, parameters.machine.cnc) : std::move(of_feed));
    append(findings, check_floors(*feed, parameters.machine));
    return findings;
}

}  // namespace millforce::host
