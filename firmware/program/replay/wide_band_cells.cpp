// SPDX-License-Identifier: Apache-2.0
#include "replay/wide_band_cells.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "files/csv.hpp"
#include "firmware/tick_record.hpp"

namespace millforce::host {

namespace {

using Estimate = estimation::Measurement<float>;
using Estimates = firmware::WideBandEstimate<float>;
using Tool = firmware::ToolParameters<float>;

constexpr float no_estimate = firmware::TickRecord::no_estimate;

float value_of(const Estimate& m) {
    return m.valid ? m.value : no_estimate;
}

float sd_of(const Estimate& m) {
    return m.valid ? std::sqrt(m.variance) : no_estimate;
}

float variation_percent(const Estimate& m, float nominal) {
    return m.valid ? 100.0F * (m.value / nominal - 1.0F) : no_estimate;
}

constexpr std::array<WideBandColumn, 8> columns{{
    {"force_drop_immersion", [](const Estimates& e, const Tool&) { return value_of(e.force_drop_immersion); }},
    {"force_drop_immersion_sd", [](const Estimates& e, const Tool&) { return sd_of(e.force_drop_immersion); }},
    {"depth_shape_axial_depth_mm", [](const Estimates& e, const Tool&) { return value_of(e.axial_depth_mm); }},
    {"depth_shape_axial_depth_sd_mm", [](const Estimates& e, const Tool&) { return sd_of(e.axial_depth_mm); }},
    {"depth_shape_radial_width_mm", [](const Estimates& e, const Tool&) { return value_of(e.radial_width_mm); }},
    {"depth_shape_radial_width_sd_mm", [](const Estimates& e, const Tool&) { return sd_of(e.radial_width_mm); }},
    {"depth_shape_axial_variation_percent",
     [](const Estimates& e, const Tool& tool) {
         return variation_percent(e.axial_depth_mm, tool.depth_shape.nominal_axial_depth_mm);
     }},
    {"depth_shape_radial_variation_percent",
     [](const Estimates& e, const Tool& tool) {
         return variation_percent(e.radial_width_mm, tool.depth_shape.nominal_radial_width_mm);
     }},
}};

}  // namespace

std::span<const WideBandColumn> wide_band_columns() {
    return columns;
}

void WideBandCells::show_what_is_missing() const {
    for (const std::string_view line : {lacking_for_force_drops(), lacking_for_depths()}) {
        if (has_sensor_ && !line.empty()) {
            fmt::print(stderr, "millforce: note: {}\n", line);
        }
    }
}

void WideBandCells::write_header(std::ostream& out) const {
    for (const WideBandColumn& column : columns) {
        out << (is_there_ ? fmt::format(",{}", column.name) : "");
    }
}

void WideBandCells::write(std::ostream& out, const Estimates& made) const {
    for (const WideBandColumn& column : columns) {
        if (is_there_) {
            const float value = column.value(made, tool_);
            out << ',' << (std::isnan(value) ? "" : CsvWriter::cell(value));
        }
    }
}

std::string WideBandCells::summary(const Estimates& made) const {
    std::string text;
    if (is_there_ && lacking_for_force_drops().empty()) {
        text += fmt::format("immersion from force drops: {} estimates of {} that were due\n", made.force_drops_valid,
                            made.force_drops);
        if (made.force_drops_of_another_filter > 0) {
            text += fmt::format(
                "  in {} of them another corner of the low-pass explains the force clearly better: {} is not as told\n",
                made.force_drops_of_another_filter,
                has_sensor_ ? "force_sensor.low_pass_hz" : "that of the drives, by sample_rate_hz,");
        }
    }
    if (has_sensor_ && lacking_for_depths().empty()) {
        text += fmt::format("depths from the force's shape: {} estimates of {} that were due\n", made.depths_valid,
                            made.depths);
    }
    return text;
}

std::string_view WideBandCells::lacking_for_force_drops() const {
    if (!firmware::has_force_drop_law(tool_)) {
        return "no immersion from force drops: the tool has no calibrated [force_drop] table";
    }
    return has_sensor_ && !firmware::has_force_sensor(tool_)
               ? "no immersion from force drops of the sensor: the tool's [force_sensor] table has no low_pass_hz"
               : "";
}

std::string_view WideBandCells::lacking_for_depths() const {
    if (!firmware::has_nominal_depths(tool_)) {
        return "no depths from the force's shape: the tool's [depth_shape] table has no nominal_axial_depth_mm or "
               "no nominal_radial_width_mm";
    }
    if (!firmware::force_has_shape(tool_)) {
        return "no depths from the force's shape: it takes a helix of at least 5° and a wall to one side";
    }
    return firmware::has_force_sensor(tool_)
               ? ""
               : "no depths from the force's shape: the tool's [force_sensor] table has no low_pass_hz";
}

}  // namespace millforce::host
