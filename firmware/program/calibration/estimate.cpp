// SPDX-License-Identifier: Apache-2.0
#include "calibration/estimate.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_units.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

namespace millforce::host {

namespace {

using estimation::CutSide;
using estimation::CuttingLaw;

constexpr std::array<std::string_view, 8> appended_columns{
    "predicted_spindle_torque_Nm", "predicted_spindle_torque_Nm_sd", "predicted_normal_force_N",
    "predicted_normal_force_N_sd", "axial_depth_from_torque_mm",     "axial_depth_from_torque_mm_sd",
    "radial_width_from_torque_mm", "radial_width_from_torque_mm_sd"};

/// Torque of the row's cut at another width, and its standard deviation.
Estimated torque_Nm(const CuttingLaw<double>& law, CutSide side, const CutRow& row, double width_mm) {
    const auto forces = estimation::average_forces_with_doubt(
        law, {row.feed_per_tooth_mm(), row.axial_depth_mm, row.engagement(side, width_mm), row.flutes});
    const double lever_m = row.radius_mm() / 1000.0;
    return {forces.mean.tangential_N * lever_m, forces.standard_deviation.tangential_N * lever_m};
}

/// The torque rises with the width (F_at grows as c^(1+p_s)), so that bisection finds the one width of a torque.
Estimated width_from_torque(const CuttingLaw<double>& law, CutSide side, const CutRow& row) {
    const double measured = row.spindle_torque_Nm;
    double low = 0.0;
    double high = row.tool_diameter_mm;
    const Estimated slot = torque_Nm(law, side, row, high);
    if (!(measured > 0.0) || measured > slot.value + 2.0 * slot.sd) {
        return {};
    }
    constexpr int halvings = 60;
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        (torque_Nm(law, side, row, middle).value < measured ? low : high) = middle;
    }
    const double width = 0.5 * (low + high);
    const double step = 0.01 * row.tool_diameter_mm;
    const double below = std::max(width - step, 0.0);
    const double above = std::min(width + step, row.tool_diameter_mm);
    const double slope =
        (torque_Nm(law, side, row, above).value - torque_Nm(law, side, row, below).value) / (above - below);
    return {width, torque_Nm(law, side, row, width).sd / slope};
}

/// Mean absolute relative error against what was measured.
struct ErrorMean {
    double sum = 0.0;
    double count = 0.0;

    void add(double estimated, double measured) {
        if (std::isfinite(estimated) && std::isfinite(measured) && measured != 0.0) {
            sum += std::abs(estimated / measured - 1.0);
            count += 1.0;
        }
    }

    std::string text(std::string_view name) const {
        return count > 0.0 ? fmt::format("  {}: {:.1f} % mean error over {} rows\n", name, 100.0 * sum / count, count)
                           : std::string();
    }
};

/// What the summary says.
struct Summary {
    std::size_t rows = 0;
    std::size_t outside = 0;
    ErrorMean torque, normal_force, depth, width;
    std::vector<double> torques_over_law;

    void add(const CutRow& row, const RowEstimates& e, const CuttingLaw<double>& law) {
        ++rows;
        constexpr double rounding = 1e-6;  // the file of the law holds rounded numbers
        const bool ranged = law.maximum_chip_thickness_mm > 0.0;
        outside += ranged && (e.chip_thickness_mm < law.minimum_chip_thickness_mm * (1.0 - rounding) ||
                              e.chip_thickness_mm > law.maximum_chip_thickness_mm * (1.0 + rounding))
                       ? 1U
                       : 0U;
        torque.add(e.spindle_torque_Nm.value, row.spindle_torque_Nm);
        const double over_law = row.spindle_torque_Nm / e.spindle_torque_Nm.value;
        if (std::isfinite(over_law)) {
            torques_over_law.push_back(over_law);
        }
        normal_force.add(e.normal_force_N.value, row.normal_force_N);
        depth.add(e.axial_depth_mm.value, row.axial_depth_mm);
        width.add(e.radial_width_mm.value, row.radial_width_mm);
    }
};

void print_summary(std::ostream& out, const Summary& summary, const CuttingLaw<double>& law) {
    out << fmt::format("{} rows\n", summary.rows) << summary.torque.text("predicted_spindle_torque_Nm")
        << summary.normal_force.text("predicted_normal_force_N") << summary.depth.text("axial_depth_from_torque_mm")
        << summary.width.text("radial_width_from_torque_mm");
    if (summary.outside > 0) {
        out << fmt::format("  {} rows lie outside the calibrated chip thickness of {:.4g} to {:.4g} mm: extrapolated\n",
                           summary.outside, law.minimum_chip_thickness_mm, law.maximum_chip_thickness_mm);
    }
}

/// Measured torques that are far from the tool's law: another unit, another material, or a reversed sign.
UnitQuestions ask_about_torques(std::vector<double> torques_over_law) {
    constexpr double most = 4.0;
    const double middle = torques_over_law.empty() ? 1.0 : median_of(std::move(torques_over_law));
    if (middle <= most && middle * most >= 1.0) {
        return {};
    }
    return {
        fmt::format("spindle_torque_Nm is {:.3g} times what the tool's law predicts (median); expected a quarter to "
                    "four times; is it in another unit, is spindle_rad_s in 1/s, or was another material cut?",
                    middle)};
}

void refuse_present_columns(const CsvReader& csv) {
    for (const std::string_view name : appended_columns) {
        if (csv.find(name)) {
            throw InputError(fmt::format("{}:1: column '{}' is there already; expected conditions without estimates",
                                         csv.file_name(), name));
        }
    }
}

}  // namespace

RowEstimates estimate_row(const CuttingLaw<double>& law, CutSide side, const CutRow& row) {
    RowEstimates result;
    const bool width_known = std::isfinite(row.radial_width_mm);
    const bool depth_known = std::isfinite(row.axial_depth_mm);
    if (width_known) {
        const auto engagement = row.engagement(side, row.radial_width_mm);
        result.chip_thickness_mm = estimation::mean_chip_thickness_mm(row.feed_per_tooth_mm(), engagement);
        CutRow unit = row;
        unit.axial_depth_mm = 1.0;
        const Estimated per_mm = torque_Nm(law, side, unit, row.radial_width_mm);
        if (row.spindle_torque_Nm > 0.0 && per_mm.value > 0.0) {
            result.axial_depth_mm.value = row.spindle_torque_Nm / per_mm.value;
            result.axial_depth_mm.sd = result.axial_depth_mm.value * per_mm.sd / per_mm.value;
        }
    }
    if (depth_known && std::isfinite(row.spindle_torque_Nm)) {
        result.radial_width_mm = width_from_torque(law, side, row);
    }
    if (width_known && depth_known) {
        result.spindle_torque_Nm = torque_Nm(law, side, row, row.radial_width_mm);
        const auto forces = estimation::average_forces_with_doubt(law, row.measurement(side).cut);
        result.normal_force_N = {-forces.mean.normal_N, forces.standard_deviation.normal_N};
    }
    return result;
}

int estimate(const EstimateOptions& options, std::ostream& out) {
    const ToolLaw tool = read_tool_law(options.tool);
    const CutSide side = options.side == CutSide::unknown ? tool.side : options.side;
    ConditionsReader reader(options.conditions);
    refuse_present_columns(reader.csv());
    std::optional<AtomicFile> file;
    if (!options.output.empty()) {
        file.emplace(options.output);
    }
    // Without a file, an error in the last row must not leave half a table behind: rows go out when all are good.
    std::string table = reader.csv().header_text();
    for (const std::string_view name : appended_columns) {
        table.append(",").append(name);
    }
    table += '\n';
    Summary summary;
    CutRow row;
    Progress progress("estimating " + reader.csv().file_name());
    while (reader.next(row)) {
        refuse_implausible_cut(row_place(reader.csv()),
                               {row.tool_diameter_mm, row.feed_mm_s, row.feed_per_tooth_mm(), row.spindle_rad_s},
                               "feed_mm_s", "spindle_rad_s");
        const RowEstimates e = estimate_row(tool.law, side, row);
        table += reader.csv().row_text();
        for (const Estimated& value : {e.spindle_torque_Nm, e.normal_force_N, e.axial_depth_mm, e.radial_width_mm}) {
            table.append(",").append(CsvWriter::cell(value.value)).append(",").append(CsvWriter::cell(value.sd));
        }
        table += '\n';
        summary.add(row, e, tool.law);
        progress.update(reader.csv().fraction_read());
        if (file) {
            file->stream() << table;
            table.clear();
        }
    }
    if (summary.rows == 0) {
        throw InputError(fmt::format("{}: no rows after the header, expected cuts", reader.csv().file_name()));
    }
    const UnitQuestions questions = ask_about_torques(std::move(summary.torques_over_law));
    if (!file) {
        out << table;
        return ask(std::cerr, questions, exit_done);
    }
    file->stream() << table;
    file->commit();
    print_summary(out, summary, tool.law);
    return ask(out, questions, exit_done);
}

}  // namespace millforce::host
