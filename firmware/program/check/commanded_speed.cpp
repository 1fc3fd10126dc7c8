// SPDX-License-Identifier: Apache-2.0
#include "check/commanded_speed.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "calibration/plausible_units.hpp"
#include "estimation/number/circle.hpp"
#include "firmware/commanded_speed.hpp"

namespace millforce::host {

namespace {

using WhileItRuns = firmware::CommandedSpeed<double>;

constexpr const char* command_key = "commanded_speed_rad_s";
constexpr double rpm_per_rad_s = 60.0 / estimation::turn_rad<double>;

/// A speed that was written down in another unit than rad/s.
const char* unit_of_command(double turned_by_commanded) {
    constexpr double near_share = 0.05;
    const auto is_near = [turned_by_commanded](double ratio) {
        return std::abs(turned_by_commanded / ratio - 1.0) < near_share;
    };
    return is_near(1.0 / rpm_per_rad_s)                    ? "is it in rpm?"
           : is_near(estimation::turn_rad<double>)         ? "is it in rev/s?"
           : is_near(estimation::turn_rad<double> / 360.0) ? "is it in deg/s?"
                                                           : nullptr;
}

}  // namespace

std::optional<double> ratio_to_commanded_speed(std::span<const MotionWindow> windows) {
    std::vector<double> ratios;
    const MotionWindow* last = nullptr;
    double even_s = 0.0;
    for (const MotionWindow& window : windows) {
        const bool goes_on = last != nullptr && window.turns_steadily() && window.commanded_rad_s > 0.0 &&
                             window.commanded_rad_s == last->commanded_rad_s;
        even_s = goes_on ? even_s + window.duration_s : 0.0;
        if (even_s > WhileItRuns::settled_s) {
            ratios.push_back(window.spindle_rad_s() / window.commanded_rad_s);
        }
        last = &window;
    }
    if (ratios.empty()) {
        return std::nullopt;
    }
    return median_of(std::move(ratios));
}

Findings check_commanded_speed(std::optional<double> ratio, const firmware::MachineParameters<float>& machine,
                               bool counts_are_proven) {
    if (!ratio || std::abs(*ratio - 1.0) <= WhileItRuns::largest_share) {
        return {};
    }
    const std::string seen =
        fmt::format("spindle: by the encoder it turns at {:.4g} times the commanded speed", *ratio);
    if (const char* unit = unit_of_command(*ratio)) {
        return {{Severity::error, fmt::format("{}; {}", seen, unit), command_key}};
    }
    if (counts_are_proven) {
        return {{Severity::error, seen + ", and index pulses prove its counts; is there a gear, or an override?",
                 command_key}};
    }
    return {{Severity::error,
             fmt::format("{}: {:.0f} counts per revolution instead of {}?", seen,
                         *ratio * machine.encoder_counts_per_rev, machine.encoder_counts_per_rev),
             "spindle.encoder_counts_per_rev"}};
}

}  // namespace millforce::host
