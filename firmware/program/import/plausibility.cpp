// SPDX-License-Identifier: Apache-2.0
#include "import/plausibility.hpp"

#include <fmt/format.h>

#include <cmath>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

constexpr double fastest_axis_mm_s = 2000.0;
constexpr double largest_current_A = 500.0;
constexpr double largest_force_N = 1e5;
constexpr double largest_override = 3.0;
constexpr double fastest_spindle_rpm = 1e5;
constexpr double fastest_spindle_rad_s = fastest_spindle_rpm * estimation::turn_rad<double> / 60.0;
constexpr double largest_fall_rad = 0.1;  // a spindle at rest may oscillate by less
constexpr double slowest_rate_hz = 20.0;
constexpr double fastest_rate_hz = 1e6;

std::string unit_doubt(const ColumnMap& column, double largest, const char* limit, const char* likely) {
    return fmt::format("{} reaches {:.4g}, more than {}; its unit is \"{}\": {}", column.column.name, largest, limit,
                       column.unit, likely);
}

std::string velocity_doubt(const ColumnMap& column, double largest) {
    const char* likely = column.derived_from == Derivation::position
                             ? "is it mm or counts, and does the position begin again somewhere (wrap)?"
                         : column.unit == "mm/s"  ? "is it mm/min, or um/s (scale = 0.001)?"
                         : column.unit == "m/s"   ? "is it m/min or mm/s?"
                         : column.unit == "m/min" ? "is it mm/min or mm/s?"
                                                  : "is it right, and what it is divided by?";
    return unit_doubt(column, largest, "2 m/s", likely);
}

/// Of what the CNC commands, a feed or a speed.
std::vector<std::string> command_doubts(const ColumnMap& column, const ColumnStatistics& command, double largest,
                                        const char* limit, const char* likely) {
    if (command.minimum() < 0.0) {
        return {fmt::format("{} falls to {:.4g}, expected nothing below 0: is it sign = -1?", column.column.name,
                            command.minimum())};
    }
    if (command.maximum() > largest) {
        return {unit_doubt(column, command.maximum(), limit, likely)};
    }
    return {};
}

std::string current_doubt(const ColumnMap& column, double largest) {
    const char* likely = column.unit == "A"       ? "is it mA, % or permille of the rated current?"
                         : column.unit == "rated" ? "is it % or permille?"
                         : column.unit == "%"     ? "is it permille, and is rated_A right?"
                                                  : "is it right, and rated_A?";
    return unit_doubt(column, largest, "500 A", likely);
}

std::vector<std::string> angle_doubts(const ColumnMap& column, const ColumnStatistics& angle, double duration_s) {
    std::vector<std::string> doubts;
    const double range_rad = angle.maximum() - angle.minimum();
    const double speed_rpm = std::abs(angle.change()) / duration_s * 60.0 / estimation::turn_rad<double>;
    if (range_rad == 0.0) {
        doubts.push_back(fmt::format("{} does not change: is it another column?", column.column.name));
    } else if (angle.falls() > 0 && angle.largest_fall() > 0.5 * range_rad && column.wrap == 0.0) {
        doubts.push_back(fmt::format("{} falls back {} time{}, by up to {:.4g} rad: does it begin again there (wrap)?",
                                     column.column.name, angle.falls(), angle.falls() == 1 ? "" : "s",
                                     angle.largest_fall()));
    } else if (angle.change() < 0.0) {
        doubts.push_back(
            fmt::format("{} falls, by {:.4g} rad in all: is it sign = -1?", column.column.name, -angle.change()));
    } else if (angle.largest_fall() > largest_fall_rad) {
        doubts.push_back(
            fmt::format("{} falls back {} time{}, by up to {:.4g} rad: does it go on by more than half of "
                        "wrap from one sample to the next?",
                        column.column.name, angle.falls(), angle.falls() == 1 ? "" : "s", angle.largest_fall()));
    }
    if (speed_rpm > fastest_spindle_rpm) {
        doubts.push_back(fmt::format("{} turns at {:.3g} rpm; its unit is \"{}\": is it deg or counts?",
                                     column.column.name, speed_rpm, column.unit));
    }
    return doubts;
}

}  // namespace

std::vector<std::string> doubts_about(const ColumnMap& column, const ColumnStatistics& statistics, double duration_s) {
    if (statistics.count() == 0) {
        const bool is_slope = column.derived_from == Derivation::position;
        const bool is_index = column.derived_from == Derivation::index;
        return {fmt::format("{} has no value at all{}", column.column.name,
                            is_slope   ? ": is smoothing_s shorter than two steps of the position?"
                            : is_index ? ": is the threshold right, and are two pulses at most 2 s apart?"
                                       : "")};
    }
    const double largest = statistics.largest_magnitude();
    switch (column.column.quantity) {
        case Quantity::velocity:
            return largest > fastest_axis_mm_s ? std::vector{velocity_doubt(column, largest)}
                                               : std::vector<std::string>{};
        case Quantity::current:
            return largest > largest_current_A ? std::vector{current_doubt(column, largest)}
                                               : std::vector<std::string>{};
        case Quantity::force:
            return largest > largest_force_N ? std::vector{unit_doubt(column, largest, "100 kN", "is it N?")}
                                             : std::vector<std::string>{};
        case Quantity::ratio:
            return largest > largest_override ? std::vector{unit_doubt(column, largest, "3", "is it %?")}
                                              : std::vector<std::string>{};
        case Quantity::feed:
            return command_doubts(column, statistics, fastest_axis_mm_s, "2 m/s", "is it mm/min?");
        case Quantity::speed:
            return command_doubts(column, statistics, fastest_spindle_rad_s, "100,000 rpm", "is it rpm?");
        case Quantity::angle:
            return angle_doubts(column, statistics, duration_s);
        default:
            return {};
    }
}

std::vector<std::string> doubts_about_times(const StepStatistics& steps) {
    if (steps.rate_hz() < slowest_rate_hz) {
        return {fmt::format("{:.3g} rows per second: too slow to see a tooth; is the unit of time ms, us or ns?",
                            steps.rate_hz())};
    }
    if (steps.rate_hz() > fastest_rate_hz) {
        return {fmt::format("{:.3g} rows per second: is the unit of time s?", steps.rate_hz())};
    }
    return {};
}

}  // namespace millforce::host
