// SPDX-License-Identifier: Apache-2.0
#include "check/drive_keys.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace millforce::host {

std::string key_of_current(const firmware::MachineParameters<float>& machine, std::size_t drive,
                           std::string_view bus_key) {
    return machine.bus.drives.at(drive).node_id > 0 ? fmt::format("bus.{}.{}", drive_names.at(drive), bus_key)
                                                    : fmt::format("{}_current_A", drive_names.at(drive));
}

double rated_current_A(const firmware::MachineParameters<float>& machine, std::size_t drive) {
    return static_cast<double>(drive == 0 ? machine.spindle_rated_current_A
                                          : machine.axis_rated_current_A.at(drive - 1));
}

double largest_current_A(const firmware::MachineParameters<float>& machine, std::size_t drive) {
    constexpr double largest_of_any_drive_A = 500.0;
    const double rated_A = rated_current_A(machine, drive);
    return rated_A > 0.0 ? rated_A * static_cast<double>(machine.bus.drives.at(drive).largest_share_of_rated)
                         : largest_of_any_drive_A;
}

int peak_for_rms(double ratio) {
    constexpr double tolerance = 0.06;
    const auto is_near = [&](double expected) { return std::abs(ratio / expected - 1.0) < tolerance; };
    return is_near(std::numbers::sqrt2) ? 1 : is_near(0.5 * std::numbers::sqrt2) ? -1 : 0;
}

std::string words_for_peak_and_rms(int direction) {
    return direction > 0 ? "a current in peak instead of rms amperes does that (factor 1.41)"
                         : "a current in rms instead of peak amperes does that (factor 0.71)";
}

}  // namespace millforce::host
