// SPDX-License-Identifier: Apache-2.0
#include "check/contradictions.hpp"

#include "check/drive_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace millforce::host {

namespace {

using Machine = firmware::MachineParameters<float>;
using Tool = firmware::ToolParameters<float>;

/// Collects the findings whose condition holds.
class Contradictions {
  public:
    void find_if(bool is_found, Severity severity, std::string key, std::string words) {
        if (is_found) {
            findings_.push_back({severity, std::move(words), std::move(key)});
        }
    }
    [[nodiscard]] Findings take() { return std::move(findings_); }

  private:
    Findings findings_;
};

Findings check_override(const Machine& machine) {
    const auto& cnc = machine.cnc;
    Contradictions found;
    found.find_if(
        cnc.override_max <= cnc.override_min, Severity::error, "cnc.override_max",
        fmt::format("override_max = {:g} is not above override_min = {:g}: the controller would hold the feed",
                    cnc.override_max, cnc.override_min));
    found.find_if(cnc.stale_s * cnc.sample_rate_hz < 2.0F, Severity::error, "cnc.stale_s",
                  fmt::format("the input would count as stale after {:g} s, less than two samples at {:g} Hz",
                              cnc.stale_s, cnc.sample_rate_hz));
    return found.take();
}

Findings check_bus(const Machine& machine, const Tool& tool) {
    constexpr float same_rate = 0.05F;
    const auto& bus = machine.bus;
    const bool is_used =
        std::any_of(bus.drives.begin(), bus.drives.end(), [](const auto& drive) { return drive.node_id > 0; });
    Contradictions found;
    const float sync_hz = 1000.0F / bus.sync_period_ms;
    found.find_if(is_used && std::abs(sync_hz / machine.cnc.sample_rate_hz - 1.0F) > same_rate, Severity::warning,
                  "cnc.sample_rate_hz",
                  fmt::format("{:g} Hz, and bus.sync_period_ms = {:g} ms gives {:.4g} Hz", machine.cnc.sample_rate_hz,
                              bus.sync_period_ms, sync_hz));
    for (std::size_t drive = 1; drive < bus.drives.size(); ++drive) {
        found.find_if(
            bus.drives[drive].node_id > 0 &&
                bus.drives[drive].largest_velocity_mm_s < tool.control.highest_programmed_feed_mm_s,
            Severity::warning, fmt::format("bus.{}.largest_velocity_mm_s", drive_names[drive]),
            fmt::format("{}: velocities above {:g} mm/s are not used, and the program has feeds up to {:g} mm/s",
                        drive_names[drive], bus.drives[drive].largest_velocity_mm_s,
                        tool.control.highest_programmed_feed_mm_s));
    }
    return found.take();
}

Findings check_drives(const Machine& machine, const Tool& tool) {
    constexpr float deviations = 4.0F;
    const auto& spindle = machine.spindle;
    Contradictions found;
    found.find_if(spindle.K_t2_Nm > deviations * spindle.idle_torque_sd_Nm, Severity::warning, "spindle.K_t2_Nm",
                  fmt::format("{:g} N·m at no current would turn the spindle by itself, more than four of its standard "
                              "deviations; is the sign wrong?",
                              spindle.K_t2_Nm));
    for (std::size_t place = 0; place < machine.axes.size(); ++place) {
        const auto& axis = machine.axes[place];
        const std::string_view name = drive_names[place + 1];
        const float doubt_A = deviations * std::max(axis.friction_ripple_A, axis.friction_relative_sd * axis.K_x3_A);
        found.find_if(
            axis.K_x3_A < -doubt_A, Severity::warning, fmt::format("{}.K_x3_A", name),
            fmt::format("{}: the constant friction is negative, {:g} A: is the current reversed?", name, axis.K_x3_A));
        found.find_if(
            axis.K_x4_N_per_A > 0.0F && tool.control.highest_programmed_feed_mm_s > 0.0F &&
                axis.velocity_floor_mm_s > tool.control.highest_programmed_feed_mm_s,
            Severity::warning, fmt::format("{}.velocity_floor_mm_s", name),
            fmt::format("{}: no force below {:g} mm/s, and the program's highest feed is {:g} mm/s; is one of "
                        "them in mm/min?",
                        name, axis.velocity_floor_mm_s, tool.control.highest_programmed_feed_mm_s));
    }
    return found.take();
}

/// The depth that the tool may meet: the declared one, else all of its flutes.
double deepest_cut_mm(const Tool& tool) {
    return static_cast<double>(tool.declared_axial_depth_mm > 0.0F ? tool.declared_axial_depth_mm
                                                                   : tool.flute_length_mm);
}

Findings check_limit(const Tool& tool) {
    const double limit_N = static_cast<double>(tool.tooth_force_limit_N);
    const double depth_mm = deepest_cut_mm(tool);
    const double edge_N = edge_force_of_tooth_N(tool, depth_mm);
    Contradictions found;
    found.find_if(edge_N > limit_N, Severity::warning, "tool.tooth_force_limit_N",
                  fmt::format("at a depth of {:g} mm the edge alone loads a tooth by {:.4g} N, above its limit of {:g} "
                              "N: no feed is small enough; is flute_length_mm, K_te or K_re right?",
                              depth_mm, edge_N, limit_N));
    found.find_if(tool.control.contact_force_N >= tool.tooth_force_limit_N, Severity::error, "control.contact_force_N",
                  fmt::format("contact is seen from {:g} N on, and a tooth may carry {:g} N",
                              tool.control.contact_force_N, tool.tooth_force_limit_N));
    return found.take();
}

Findings check_geometry(const Tool& tool) {
    Contradictions found;
    const auto deeper = [&](float depth_mm, const char* key) {
        found.find_if(depth_mm > tool.flute_length_mm, Severity::error, "tool.flute_length_mm",
                      fmt::format("a flute of {:g} mm is shorter than {} = {:g}", tool.flute_length_mm, key, depth_mm));
    };
    deeper(tool.declared_axial_depth_mm, "control.declared_axial_depth_mm");
    deeper(tool.depth_shape.nominal_axial_depth_mm, "depth_shape.nominal_axial_depth_mm");
    deeper(tool.roughness.minimum[3], "roughness.axial_depth_minimum_mm");
    found.find_if(tool.depth_shape.nominal_radial_width_mm > tool.diameter_mm, Severity::error,
                  "depth_shape.nominal_radial_width_mm",
                  fmt::format("a width of {:g} mm is larger than the tool's Ø{:g} mm",
                              tool.depth_shape.nominal_radial_width_mm, tool.diameter_mm));
    return found.take();
}

/// A calibration puts the reference where it knows most, which may lie outside of its cuts. Ten times as thick or as
/// thin is another unit.
bool is_far_from_range(const estimation::CuttingLaw<float>& law) {
    constexpr float far = 10.0F;
    const float reference_mm = law.reference_chip_thickness_mm;
    const bool is_known = reference_mm > 0.0F && law.maximum_chip_thickness_mm > 0.0F;
    return is_known &&
           (reference_mm > far * law.maximum_chip_thickness_mm || far * reference_mm < law.minimum_chip_thickness_mm);
}

Findings check_law(const Tool& tool) {
    const auto& law = tool.law;
    const auto& control = tool.control;
    Contradictions found;
    found.find_if(law.maximum_chip_thickness_mm > 0.0F && law.maximum_chip_thickness_mm < law.minimum_chip_thickness_mm,
                  Severity::error, "cutting.maximum_chip_thickness_mm",
                  fmt::format("{:g} mm is below minimum_chip_thickness_mm = {:g}", law.maximum_chip_thickness_mm,
                              law.minimum_chip_thickness_mm));
    found.find_if(
        is_far_from_range(law), Severity::warning, "cutting.reference_chip_thickness_mm",
        fmt::format("{:g} mm is ten times or more beyond the calibrated chips of {:g} to {:g} mm: is it in "
                    "another unit?",
                    law.reference_chip_thickness_mm, law.minimum_chip_thickness_mm, law.maximum_chip_thickness_mm));
    found.find_if(control.max_feed_per_tooth_mm < law.minimum_chip_thickness_mm, Severity::warning,
                  "control.max_feed_per_tooth_mm",
                  fmt::format("no chip is as thick as the thinnest calibrated one: {:g} mm per tooth at most, and "
                              "cutting.minimum_chip_thickness_mm = {:g}",
                              control.max_feed_per_tooth_mm, law.minimum_chip_thickness_mm));
    found.find_if(control.entry_feed_per_tooth_mm > control.max_feed_per_tooth_mm, Severity::error,
                  "control.max_feed_per_tooth_mm",
                  fmt::format("{:g} mm is below entry_feed_per_tooth_mm = {:g}", control.max_feed_per_tooth_mm,
                              control.entry_feed_per_tooth_mm));
    return found.take();
}

}  // namespace

double edge_force_of_tooth_N(const Tool& tool, double axial_depth_mm) {
    const double force_N_per_mm =
        std::hypot(static_cast<double>(tool.law.K_te_N_per_mm), static_cast<double>(tool.law.K_re_N_per_mm));
    const double rad_per_mm = std::tan(static_cast<double>(tool.helix_deg) * std::numbers::pi / 180.0) /
                              (0.5 * static_cast<double>(tool.diameter_mm));
    const double engaged_mm =
        rad_per_mm > 0.0 ? std::min(axial_depth_mm, std::numbers::pi / rad_per_mm) : axial_depth_mm;
    const double half_lag_rad = 0.5 * rad_per_mm * engaged_mm;
    return force_N_per_mm * engaged_mm * (half_lag_rad > 0.0 ? std::sin(half_lag_rad) / half_lag_rad : 1.0);
}

Findings check_contradictions(const firmware::Parameters<float>& parameters) {
    Findings findings = check_override(parameters.machine);
    append(findings, check_bus(parameters.machine, parameters.tool));
    append(findings, check_drives(parameters.machine, parameters.tool));
    append(findings, check_limit(parameters.tool));
    append(findings, check_geometry(parameters.tool));
    append(findings, check_law(parameters.tool));
    return findings;
}

}  // namespace millforce::host
