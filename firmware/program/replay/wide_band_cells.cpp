// SPDX-License-Identifier: Apache-2.0
#include "replay/wide_band_cells.hpp"

#include <fmt/format.h>

#include <cmath>

#include "files/csv.hpp"

namespace millforce::host {

namespace {

using Estimate = estimation::Measurement<float>;

void write_with_sd(std::ostream& out, const Estimate& m) {
    out << ',' << (m.valid ? CsvWriter::cell(m.value) + ',' + CsvWriter::cell(std::sqrt(m.variance)) : ",");
}

void write_variation(std::ostream& out, const Estimate& m, float nominal) {
    out << ',' << (m.valid ? CsvWriter::cell(100.0F * (m.value / nominal - 1.0F)) : "");
}

}  // namespace

void WideBandCells::show_what_is_missing() const {
    for (const std::string_view line : {lacking_for_force_drops(), lacking_for_depths()}) {
        if (has_sensor_ && !line.empty()) {
            fmt::print(stderr, "millforce: note: {}\n", line);
        }
    }
}

void WideBandCells::write_header(std::ostream& out) const {
    out << (is_there_ ? ",force_drop_immersion,force_drop_immersion_sd,depth_shape_axial_depth_mm,"
                        "depth_shape_axial_depth_sd_mm,depth_shape_radial_width_mm,depth_shape_radial_width_sd_mm,"
                        "depth_shape_axial_variation_percent,depth_shape_radial_variation_percent"
                      : "");
}

void WideBandCells::write(std::ostream& out, const Estimates& made) const {
    if (!is_there_) {
        return;
    }
    write_with_sd(out, made.force_drop_immersion);
    write_with_sd(out, made.axial_depth_mm);
    write_with_sd(out, made.radial_width_mm);
    write_variation(out, made.axial_depth_mm, tool_.depth_shape.nominal_axial_depth_mm);
    write_variation(out, made.radial_width_mm, tool_.depth_shape.nominal_radial_width_mm);
}

std::string WideBandCells::summary(const Estimates& made) const {
    std::string text;
    if (is_there_ && lacking_for_force_drops().empty()) {
        text += fmt::format("immersion from force drops: {} estimates of {} that were due\n", made.force_drops_valid,
                            made.force_drops);
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
