// SPDX-License-Identifier: Apache-2.0
#include "check/file_units.hpp"

#include "calibration/plausible_units.hpp"
#include "check/drive_keys.hpp"
#include "estimation/drives/feed_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

namespace millforce::host {

namespace {

using Machine = firmware::MachineParameters<float>;
using Tool = firmware::ToolParameters<float>;

/// The largest current that the controller uses, where the rated one is known; else 0.
double overload_current_A(const Machine& machine, std::size_t drive) {
    return rated_current_A(machine, drive) > 0.0 ? largest_current_A(machine, drive) : 0.0;
}

Findings check_spindle_units(const Machine& machine) {
    constexpr double fast_rad_s = 3000.0;
    constexpr double rpm = 30.0 / std::numbers::pi;  // in 1 rad/s
    constexpr double slowest_start_rad_s2 = 5.0;     // 1000 1/min in 20 s
    Findings findings;
    const double base_rad_s = static_cast<double>(machine.spindle.base_speed_rad_s);
    if (base_rad_s > fast_rad_s) {
        findings.push_back(
            {Severity::warning,
             fmt::format("a base speed of {:.5g} rad/s is {:.6g} 1/min; is it in 1/min?", base_rad_s, base_rad_s * rpm),
             "spindle.base_speed_rad_s"});
    }
    const double rated_A = rated_current_A(machine, 0);
    const double K_t1 = static_cast<double>(machine.spindle.K_t1_Nm_per_A);
    const double idle_A = -static_cast<double>(machine.spindle.K_t2_Nm) / K_t1;
    if (rated_A > 0.0 && std::abs(idle_A) > rated_A) {
        findings.push_back({Severity::error,
                            fmt::format("the spindle idles at {:.4g} A, more than its rated {:.4g} A; is K_t1_Nm_per_A "
                                        "in N·m per mA, or K_t2_Nm in another unit?",
                                        idle_A, rated_A),
                            "spindle.K_t2_Nm"});
    }
    const double start_Nm = K_t1 * overload_current_A(machine, 0);
    const double inertia_kg_m2 = static_cast<double>(machine.spindle.inertia_kg_m2);
    if (start_Nm > 0.0 && inertia_kg_m2 * slowest_start_rad_s2 > start_Nm) {
        findings.push_back({Severity::error,
                            fmt::format("an inertia of {:.4g} kg·m² takes the spindle's {:.4g} N·m more than 20 s to "
                                        "1000 1/min; is it in kg·cm²?",
                                        inertia_kg_m2, start_Nm),
                            "spindle.inertia_kg_m2"});
    }
    return findings;
}

/// The magnitude of the friction current at 1 m/min, the larger of both directions.
double friction_A(const estimation::FeedDriveParameters<float>& axis) {
    const float by_speed = std::max(axis.positive.at(1.0F), axis.negative.at(1.0F));
    return static_cast<double>(by_speed + axis.K_x3_A);
}

Findings check_axis_units(const Machine& machine, std::size_t place) {
    const auto& axis = machine.axes.at(place);
    const std::string_view name = drive_names.at(place + 1);
    Findings findings;
    const double rated_A = rated_current_A(machine, place + 1);
    if (rated_A > 0.0 && friction_A(axis) > rated_A) {
        findings.push_back({Severity::error,
                            fmt::format("{}: a friction of {:.4g} A is more than the rated {:.4g} A; is it in mA?",
                                        name, friction_A(axis), rated_A),
                            fmt::format("{}.K_x3_A", name)});
    }
    const double push_N = static_cast<double>(axis.K_x4_N_per_A) * overload_current_A(machine, place + 1);
    const double acceleration_m_s2 = 1e-3 * static_cast<double>(machine.cnc.acceleration_mm_s2);
    if (push_N > 0.0 && static_cast<double>(axis.mass_kg) * acceleration_m_s2 > push_N) {
        findings.push_back({Severity::error,
                            fmt::format("{}: {:.4g} kg at cnc.acceleration_mm_s2 take more than the {:.4g} N that "
                                        "the drive has at its largest current; is the mass in g?",
                                        name, static_cast<double>(axis.mass_kg), push_N),
                            fmt::format("{}.mass_kg", name)});
    }
    return findings;
}

Findings check_feeds_per_tooth(const Tool& tool) {
    struct Feed {
        const char* key;
        float mm;
    };
    const double limit_mm = largest_feed_per_tooth_mm(static_cast<double>(tool.diameter_mm));
    Findings findings;
    for (const Feed& feed : {Feed{"control.entry_feed_per_tooth_mm", tool.control.entry_feed_per_tooth_mm},
                             Feed{"control.air_feed_per_tooth_mm", tool.control.air_feed_per_tooth_mm},
                             Feed{"control.max_feed_per_tooth_mm", tool.control.max_feed_per_tooth_mm},
                             Feed{"depth_shape.feed_per_tooth_mm", tool.depth_shape.feed_per_tooth_mm}}) {
        if (static_cast<double>(feed.mm) > limit_mm) {
            findings.push_back(
                {Severity::error,
                 fmt::format("a chip of {:.4g} mm per tooth on a tool of Ø{:g} mm, expected at most "
                             "{:.3g} mm; is it in mm per revolution, or in mm/min?",
                             static_cast<double>(feed.mm), static_cast<double>(tool.diameter_mm), limit_mm),
                 feed.key});
        }
    }
    return findings;
}

/// The pressure at the tool's largest feed per tooth.
Findings check_pressure(const Tool& tool) {
    const double K_s = static_cast<double>(
        estimation::cutting_coefficients(tool.law, tool.control.max_feed_per_tooth_mm).K_s_N_per_mm2);
    if (K_s >= softest_N_per_mm2 && K_s <= hardest_N_per_mm2) {
        return {};
    }
    return {{Severity::error,
             fmt::format("a cutting pressure of {:.4g} N/mm² at max_feed_per_tooth_mm, expected {:g} to {:g}; is it in "
                         "another unit?",
                         K_s, softest_N_per_mm2, hardest_N_per_mm2),
             "cutting.k_s_N_per_mm2"}};
}

}  // namespace

Findings check_units_of_files(const firmware::Parameters<float>& parameters) {
    Findings findings = check_spindle_units(parameters.machine);
    for (std::size_t axis = 0; axis < parameters.machine.axes.size(); ++axis) {
        append(findings, check_axis_units(parameters.machine, axis));
    }
    append(findings, check_feeds_per_tooth(parameters.tool));
    append(findings, check_pressure(parameters.tool));
    return findings;
}

}  // namespace millforce::host
