// SPDX-License-Identifier: Apache-2.0
#include "check/spindle_idle.hpp"

#include "check/drive_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

namespace millforce::host {

namespace {

using SpindleParameters = estimation::SpindleDriveParameters<float>;
using SpindleAverage = estimation::SpindleDrive<float>::Average;

SpindleAverage average_of(const MotionWindow& window) {
    SpindleAverage average;
    average.current_A = static_cast<float>(window.spindle_current_A);
    average.speed_rad_s = static_cast<float>(window.spindle_rad_s());
    average.acceleration_rad_s2 = static_cast<float>(window.spindle_acceleration_rad_s2);
    average.samples = static_cast<float>(window.samples);
    average.present = true;
    return average;
}

/// The windows from which the spindle's current is judged.
std::vector<MotionWindow> turning_windows(std::span<const MotionWindow> windows, bool in_air_only) {
    std::vector<MotionWindow> chosen;
    std::copy_if(windows.begin(), windows.end(), std::back_inserter(chosen), [&](const MotionWindow& window) {
        return window.has_spindle_current && window.turns_steadily() &&
               (!in_air_only || window.place == ToolPlace::in_air);
    });
    return chosen;
}

/// The window with the median current stands for all.
MotionWindow typical(std::vector<MotionWindow> windows) {
    const auto middle = windows.begin() + static_cast<std::ptrdiff_t>(windows.size() / 2);
    std::nth_element(windows.begin(), middle, windows.end(), [](const MotionWindow& a, const MotionWindow& b) {
        return a.spindle_current_A < b.spindle_current_A;
    });
    return *middle;
}

/// The current at which the file expects no torque beyond the idle one.
double expected_idle_A(const SpindleParameters& spindle, const MotionWindow& window) {
    const estimation::SpindleDrive<float> drive(spindle);
    const auto K_t = static_cast<double>(drive.torque_constant_Nm_per_A(static_cast<float>(window.spindle_rad_s())));
    return window.spindle_current_A - torque_beyond_idle_Nm(spindle, window) / K_t;
}

/// The same of a spindle that has not warmed up yet.
double expected_cold_idle_A(const SpindleParameters& spindle, const MotionWindow& window) {
    const estimation::SpindleDrive<float> drive(spindle);
    const float K_t = drive.torque_constant_Nm_per_A(static_cast<float>(window.spindle_rad_s()));
    return expected_idle_A(spindle, window) + static_cast<double>(drive.drift_Nm() / K_t);
}

Finding reversed(const firmware::MachineParameters<float>& machine, const MotionWindow& window, const char* where) {
    return {Severity::error,
            fmt::format("spindle: the current is reversed: {:.3g} A {}, expected {:.3g} A", window.spindle_current_A,
                        where, expected_idle_A(machine.spindle, window)),
            key_of_current(machine, 0, "current_reversed")};
}

/// Of a current in air that the stated deviation of the idle torque does not explain.
Finding other_idle(const firmware::MachineParameters<float>& machine, const MotionWindow& window) {
    const double warm_A = expected_idle_A(machine.spindle, window);
    const double cold_A = expected_cold_idle_A(machine.spindle, window);
    const std::string what =
        fmt::format("spindle: {:.4g} A in air, and {:.4g} A by the file", window.spindle_current_A, warm_A) +
        (cold_A != warm_A ? fmt::format(" ({:.4g} A cold)", cold_A) : std::string());
    const int by_warm = peak_for_rms(window.spindle_current_A / warm_A);
    const int by_cold = peak_for_rms(window.spindle_current_A / cold_A);
    if (const int direction = by_warm != 0 ? by_warm : by_cold; direction != 0) {
        return {Severity::warning, what + ": " + words_for_peak_and_rms(direction),
                key_of_current(machine, 0, "current_basis")};
    }
    return {Severity::warning, what + ": the idle torque of another machine, or its current in another unit",
            "spindle.K_t2_Nm"};
}

/// Turning takes a torque: a current that is zero to within its noise, although one far above it is expected.
bool is_dead(const SpindleParameters& spindle, const MotionWindow& window) {
    constexpr double deviations = 4.0;
    const double noise_A =
        deviations * static_cast<double>(spindle.current_sd_A) / std::sqrt(static_cast<double>(window.samples));
    return std::abs(window.spindle_current_A) < noise_A && std::abs(expected_idle_A(spindle, window)) > 2.0 * noise_A;
}

/// An idle torque so far below the file's that the controller doubts the gain (SpindleDrive::gain_doubt).
Findings doubted_gain(const firmware::MachineParameters<float>& machine, const MotionWindow& window) {
    estimation::SpindleDrive<float> drive(machine.spindle);
    drive.rezero(average_of(window));
    if (!(drive.gain_doubt() > 0.0F)) {
        return {};
    }
    return {
        {Severity::warning,
         fmt::format(
             "spindle: {:.4g} A in air, and {:.4g} A by the file: if the gain is off by as much, and the current less "
             "noisy than current_sd_A says, the cut carries {:.2g} times the force shown, and the controller counts "
             "on it; calibrate the gain, or the idle torque",
             window.spindle_current_A, expected_cold_idle_A(machine.spindle, window), 1.0F + drive.gain_doubt()),
         "spindle.K_t1_Nm_per_A"}};
}

Findings check_current_in_air(std::vector<MotionWindow> air, const firmware::MachineParameters<float>& machine) {
    const MotionWindow window = typical(std::move(air));
    if (is_dead(machine.spindle, window)) {
        return {{Severity::error, "spindle: no current while it turns in air: is it connected?", "spindle_current_A"}};
    }
    if (is_plausible_idle(machine.spindle, window)) {
        Findings doubted = doubted_gain(machine, window);
        if (!doubted.empty()) {
            return doubted;
        }
        const MotionWindow peak = with_spindle_current_times(window, std::numbers::sqrt2);
        if (is_plausible_idle(machine.spindle, peak)) {
            return {{Severity::note,
                     "spindle: whether the current is peak or rms cannot be told: a factor of 1.41 is within the "
                     "stated deviation of the idle torque",
                     "spindle.idle_torque_sd_Nm"}};
        }
        return {};
    }
    if (is_plausible_idle(machine.spindle, with_spindle_current_times(window, -1.0))) {
        return {reversed(machine, window, "in air")};
    }
    return {other_idle(machine, window)};
}

/// No cut pushes the spindle: a torque below the idle one is that of a reversed current.
Findings check_sign(std::vector<MotionWindow> turning, const firmware::MachineParameters<float>& machine) {
    const MotionWindow window = typical(std::move(turning));
    const double torque_Nm = torque_beyond_idle_Nm(machine.spindle, window);
    if (torque_Nm < 0.0 && !is_plausible_idle(machine.spindle, window)) {
        return {reversed(machine, window, "while it turns")};
    }
    return {{Severity::note,
             fmt::format("spindle: no air is known in the recording, in which the idle current could be compared; the "
                         "torque is {:.3g} N·m above the idle one in the median",
                         torque_Nm),
             "spindle.K_t2_Nm"}};
}

}  // namespace

double torque_beyond_idle_Nm(const SpindleParameters& spindle, const MotionWindow& window) {
    const estimation::SpindleDrive<float> drive(spindle);
    return static_cast<double>(drive.force_N(average_of(window), 1.0F).value + drive.drift_Nm());
}

bool is_plausible_idle(const SpindleParameters& spindle, const MotionWindow& window) {
    estimation::SpindleDrive<float> drive(spindle);
    drive.rezero(average_of(window));
    return !drive.is_implausible();
}

MotionWindow with_spindle_current_times(MotionWindow window, double factor) {
    window.spindle_current_A *= factor;
    return window;
}

Findings check_spindle_current(std::span<const MotionWindow> windows, const firmware::MachineParameters<float>& machine,
                               bool current_stands) {
    const std::vector<MotionWindow> turning = turning_windows(windows, false);
    if (turning.empty()) {
        return {{Severity::note, "spindle: it never turns at a steady speed: its current is not judged",
                 "spindle_current_A"}};
    }
    if (current_stands) {
        return {{Severity::error,
                 fmt::format("spindle: the current stands at {:.3g} A while it turns: is it connected?",
                             turning.front().spindle_current_A),
                 "spindle_current_A"}};
    }
    const double largest_A = std::abs(typical(turning).spindle_current_A);
    if (largest_A > largest_current_A(machine, 0)) {
        return {{Severity::error,
                 fmt::format("spindle: a current of {:.4g} A, expected at most {:.4g} A; is it in mA, or per mille of "
                             "the rated current?",
                             largest_A, largest_current_A(machine, 0)),
                 "spindle_current_A"}};
    }
    std::vector<MotionWindow> idle = turning_windows(windows, true);
    return idle.empty() ? check_sign(turning, machine) : check_current_in_air(std::move(idle), machine);
}

}  // namespace millforce::host
