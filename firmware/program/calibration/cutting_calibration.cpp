// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/cutting_refusals.hpp"
#include "calibration/cutting_side.hpp"
#include "calibration/drive_forces.hpp"
#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_units.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace millforce::host {

namespace {

using estimation::CutSide;
using estimation::CuttingFit;
using estimation::CuttingLawForm;

std::vector<CutRow> read_cuts(const std::vector<std::filesystem::path>& files, std::ostream& out) {
    std::vector<CutRow> cuts;
    DuplicateRows duplicates;
    for (const auto& file : files) {
        ConditionsReader reader(file);
        if (!reader.has_torque()) {
            reader.csv().require("spindle_torque_Nm", "needed for K_s");
        }
        if (!reader.has_force()) {
            reader.csv().require("normal_force_N", "needed for r_1");
        }
        reader.csv().require("axial_depth_mm");
        reader.csv().require("radial_width_mm");
        CutRow row;
        while (reader.next(row)) {
            const bool measured = std::isfinite(row.spindle_torque_Nm) || std::isfinite(row.normal_force_N) ||
                                  std::isfinite(row.feed_force_N);
            if (measured && std::isfinite(row.axial_depth_mm) && std::isfinite(row.radial_width_mm) &&
                !duplicates.is_copy(reader.csv())) {
                refuse_implausible_cut(
                    row_place(reader.csv()),
                    {row.tool_diameter_mm, row.feed_mm_s, row.feed_per_tooth_mm(), row.spindle_rad_s}, "feed_mm_s",
                    "spindle_rad_s");
                cuts.push_back(row);
            }
        }
    }
    duplicates.report(out);
    if (cuts.empty()) {
        throw InputError(
            fmt::format("{}: 'k_s_N_per_mm2' cannot be determined: no row with depth, width and a measured "
                        "torque or force; expected cuts at two feeds and several widths",
                        files.front().string()));
    }
    return cuts;
}

struct CutsAndDoubt {
    std::vector<CutRow> cuts;
    estimation::DriveGainDoubt doubt;
};

/// Forces from currents. The gains of both drives come from standard cuts with one database: the smaller of their two
/// doubts is taken for shared.
CutsAndDoubt read_recordings(const CuttingCalibrationOptions& options) {
    if (options.machine.empty()) {
        throw InputError(fmt::format("{}: recordings need --machine M.toml: its gains turn currents into forces",
                                     options.cuts.string()));
    }
    const MachineParameters machine = read_machine_parameters(options.machine.string());
    const auto stretches = read_recorded_cuts(options.data, options.cuts);
    CutsAndDoubt result{forces_of_cuts(stretches, machine), {}};
    if (result.cuts.empty()) {
        throw InputError(
            fmt::format("{}: 'k_s_N_per_mm2' cannot be determined: the table has no cut; expected cuts at two "
                        "feeds and several widths",
                        options.cuts.string()));
    }
    result.doubt = gain_doubt(machine, stretches.front().axis);
    return result;
}

CuttingFit fit_on_side(const CuttingCalibrationOptions& options, const std::vector<CutRow>& cuts, CutSide side,
                       const estimation::DriveGainDoubt& doubt, unsigned held_at_zero) {
    return options.from_currents() ? fit_cuts_from_currents(cuts, options.form(), side, doubt, held_at_zero)
                                   : fit_cuts(cuts, options.form(), side, held_at_zero);
}

CutSide side_or_refuse(const CuttingCalibrationOptions& options, const std::vector<CutRow>& cuts, std::ostream& out) {
    const auto fit = [&](const std::vector<CutRow>& rows, CutSide side) {
        return fit_on_side(options, rows, side, {}, 0);
    };
    const std::string lack = what_the_cuts_lack(fit(cuts, CutSide::down), options.form());
    return side_that_fits(
        {options.data.front().string(),
         lack.empty() ? fmt::format("the fit of {} cuts does not settle; expected more cuts, at more feeds and widths",
                                    cuts.size())
                      : lack},
        cuts, options.side, fit, out);
}

/// A law and the parameters that it was fitted without.
struct CuttingResult {
    CuttingFit fit{};
    unsigned held_at_zero = 0;
    std::vector<FittedValue> left_out;
};

/// The fit without those parameters whose standard error is larger than their value. The combined law keeps them: there
/// the published values hold what the cuts leave open.
CuttingResult fit_what_is_determined(const CuttingCalibrationOptions& options, const std::vector<CutRow>& cuts,
                                     CutSide side, const estimation::DriveGainDoubt& doubt) {
    const auto fit_without = [&](unsigned held) { return fit_on_side(options, cuts, side, doubt, held); };
    std::vector<int> candidates;
    if (options.form() == CuttingLawForm::power) {
        candidates = {estimation::cutting_p_s, estimation::cutting_p_1};
    } else if (options.form() == CuttingLawForm::linear_edge) {
        candidates = {estimation::cutting_K_te, estimation::cutting_K_re};
    }
    CuttingResult result;
    result.fit = fit_without(0);
    while (const auto vague = most_vague(result.fit, candidates)) {
        std::erase(candidates, *vague);
        result.left_out.push_back({cutting_coefficient_keys[static_cast<std::size_t>(*vague)],
                                   result.fit.parameters(*vague), result.fit.standard_error(*vague)});
        result.held_at_zero |= 1U << static_cast<unsigned>(*vague);
        result.fit = fit_without(result.held_at_zero);
    }
    refuse_vague_law(options.data.front().string(), result.fit, options.form());
    return result;
}

/// Values at t = 1 mm, as the law holds them. Parameters that the chosen form does not have are 0, without a standard
/// error.
std::array<FittedValue, 6> fitted_values(const CuttingFit& fit, CuttingLawForm form) {
    const auto& law = fit.law;
    const auto& keys = cutting_coefficient_keys;
    const auto fitted = [&](const CalibrationKey& key, bool is_held, double value, int j) {
        return is_held ? FittedValue{key, 0.0, no_estimate} : FittedValue{key, value, fit.standard_error(j)};
    };
    const bool no_exponents = form == CuttingLawForm::linear_edge;
    const bool no_edge = form == CuttingLawForm::power;
    return {{{keys[0], law.k_s_N_per_mm2, fit.k_s_standard_error()},
             fitted(keys[1], no_exponents, law.p_s, estimation::cutting_p_s),
             {keys[2], law.k_1, fit.k_1_standard_error()},
             fitted(keys[3], no_exponents, law.p_1, estimation::cutting_p_1),
             fitted(keys[4], no_edge, law.K_te_N_per_mm, estimation::cutting_K_te),
             fitted(keys[5], no_edge, law.K_re_N_per_mm, estimation::cutting_K_re)}};
}

bool is_left_out(const CuttingResult& result, const CalibrationKey& key) {
    return std::any_of(result.left_out.begin(), result.left_out.end(),
                       [&](const FittedValue& left_out) { return left_out.key.name == key.name; });
}

void print_fit(std::ostream& out, const CuttingResult& result, CuttingLawForm form) {
    const CuttingFit& fit = result.fit;
    out << fmt::format("{} law, feed per tooth {:.4g} to {:.4g} mm, mean chip thickness {:.4g} to {:.4g} mm\n",
                       form_name(form), fit.minimum_feed_per_tooth_mm, fit.maximum_feed_per_tooth_mm,
                       fit.law.minimum_chip_thickness_mm, fit.law.maximum_chip_thickness_mm);
    for (const FittedValue& fitted : fitted_values(fit, form)) {
        if (!is_left_out(result, fitted.key)) {
            print_fitted(out, fitted);
        }
    }
    for (const FittedValue& left_out : result.left_out) {
        print_left_out(out, left_out);
    }
    for (const int j :
         {estimation::cutting_p_s, estimation::cutting_p_1, estimation::cutting_K_te, estimation::cutting_K_re}) {
        const std::string_view name = cutting_coefficient_keys[static_cast<std::size_t>(j)].name;
        if (form == CuttingLawForm::combined && fit.decided_by_cuts(j) < 0.5) {
            out << fmt::format("  {} is more the published value than the cuts' ({:.0f} %)\n", name,
                               100.0 * (1.0 - fit.decided_by_cuts(j)));
        } else if (form == CuttingLawForm::combined && fit.standard_error(j) > std::abs(fit.parameters(j))) {
            out << fmt::format("  {} is smaller than its standard error; the law would do without it\n", name);
        }
    }
    const auto scatter = [&](std::string_view name, const estimation::CuttingScatter& s) {
        if (s.cuts > 0) {
            out << fmt::format("  {}: {} cuts scatter {:.1f} % about the law ({:.1f} % with the odd ones: {})\n", name,
                               s.cuts, 100.0 * s.robust_sd, 100.0 * s.rms, s.odd_cuts);
        }
    };
    scatter("torque", fit.tangential);
    scatter("feed force", fit.feed);
    scatter("normal force", fit.normal);
    out << fmt::format("  stated doubt of K_s: {:.1f} % at {:.4g} mm chip thickness\n", 100.0 * fit.law.K_s_relative_sd,
                       fit.law.reference_chip_thickness_mm);
}

void print_errors(std::ostream& out, std::string_view what, CuttingLawForm form, const HeldOutErrors& e) {
    const auto text = [](double value, const char* unit) {
        return std::isnan(value) ? std::string("–") : fmt::format("{:.3g}{}", value, unit);
    };
    out << fmt::format("  {:<22} {:<12} {:>8} {:>8} {:>10} {:>8}\n", what, form_name(form),
                       text(100.0 * e.torque, " %"), text(100.0 * e.normal_force, " %"), text(e.axial_depth_mm, " mm"),
                       text(100.0 * e.within_two_sd, " %"));
}

/// Prints the table of held-out errors; returns whether the stated deviations hold for the chosen law.
bool check_held_out(std::ostream& out, const std::vector<CutRow>& cuts, CuttingLawForm chosen, CutSide side,
                    unsigned held_at_zero) {
    constexpr double share_within = 0.9;
    constexpr std::array<CuttingLawForm, 3> forms{CuttingLawForm::combined, CuttingLawForm::linear_edge,
                                                  CuttingLawForm::power};
    out << fmt::format("held out: mean error\n  {:<22} {:<12} {:>8} {:>8} {:>10} {:>8}\n", "", "law", "torque",
                       "normal", "depth", "in 2 sd");
    double within = 0.0;
    double values = 0.0;
    const auto one = [&](const std::string& what, auto errors_of) {
        for (const CuttingLawForm form : forms) {
            const HeldOutErrors errors = errors_of(form);
            print_errors(out, what, form, errors);
            if (form == chosen && !std::isnan(errors.within_two_sd)) {
                within += errors.within_two_sd * static_cast<double>(errors.cuts);
                values += static_cast<double>(errors.cuts);
            }
        }
    };
    const auto held_of = [&](CuttingLawForm form) { return form == chosen ? held_at_zero : 0U; };
    one("each width in turn",
        [&](CuttingLawForm form) { return leave_one_width_out(cuts, form, side, held_of(form)); });
    // Feeds that were measured differ in their last digits.
    const auto same_feed = [](double a, double b) { return std::abs(a - b) < 0.01 * b; };
    std::set<double> feeds;
    for (const CutRow& row : cuts) {
        if (std::none_of(feeds.begin(), feeds.end(), [&](double feed) { return same_feed(row.feed_mm_s, feed); })) {
            feeds.insert(row.feed_mm_s);
        }
    }
    constexpr std::size_t most_feeds = 20;
    for (const double feed : feeds.size() <= most_feeds ? feeds : std::set<double>{}) {
        one(fmt::format("feed {:.4g} mm/s", feed), [&](CuttingLawForm form) {
            return held_out_errors(
                cuts, form, side, [&](const CutRow& row) { return same_feed(row.feed_mm_s, feed); }, held_of(form));
        });
    }
    if (values == 0.0) {
        out << "  too few widths and feeds to hold any out: the stated deviations are unchecked\n";
        return true;
    }
    const bool holds = within >= share_within * values;
    out << fmt::format("{:.1f} % of held-out values within twice their stated deviation, bound {:.0f} %: {}\n",
                       100.0 * within / values, 100.0 * share_within, holds ? "holds" : "BROKEN");
    return holds;
}

void write_fit(const CuttingCalibrationOptions& options, const CuttingResult& result, CutSide side) {
    const CuttingFit& fit = result.fit;
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment(fmt::format("Coefficients of the cutting force, {} law: K_s = k_s t^p_s, r_1 = k_1 t^p_1, t in mm.",
                             form_name(options.form())));
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table("cutting");
    for (const FittedValue& fitted : fitted_values(fit, options.form())) {
        if (!is_left_out(result, fitted.key)) {
            write_fitted(toml, fitted);
        }
    }
    const auto& law = fit.law;
    const std::array<double, 9> doubts{law.K_s_relative_sd,
                                       law.K_s_exponent_sd,
                                       law.r_1_relative_sd,
                                       law.r_1_exponent_sd,
                                       law.reference_chip_thickness_mm,
                                       law.minimum_chip_thickness_mm,
                                       law.maximum_chip_thickness_mm,
                                       fit.minimum_feed_per_tooth_mm,
                                       fit.maximum_feed_per_tooth_mm};
    for (std::size_t j = 0; j < doubts.size(); ++j) {
        write_positive(toml, cutting_doubt_keys[j], doubts[j]);
    }
    toml.key(cut_side_key.name, side == CutSide::up ? "up" : "down");
    file.commit();
}

}  // namespace

int calibrate_cutting(const CuttingCalibrationOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate cutting: no data file; expected at least one CSV file of conditions");
    }
    const auto [cuts, doubt] =
        options.from_currents() ? read_recordings(options) : CutsAndDoubt{read_cuts(options.data, out), {}};
    const std::string file = options.data.front().string();
    const CutSource source = options.from_currents() ? CutSource::recording : CutSource::table;
    refuse_implausible_pressure(file, cuts, CutSide::down, source);
    refuse_implausible_forces(file, cuts, source);
    refuse_too_few_values(file, cuts, options.form());
    const CutSide side = side_or_refuse(options, cuts, out);
    const CuttingResult result = fit_what_is_determined(options, cuts, side, doubt);
    print_fit(out, result, options.form());
    const bool holds = check_held_out(out, cuts, options.form(), side, result.held_at_zero);
    write_fit(options, result, side);
    return ask(out, ask_about_speed_of(cuts, side, source), holds ? exit_done : exit_bound_broken);
}

}  // namespace millforce::host
