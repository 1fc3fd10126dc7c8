// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduce/hwang_checks.hpp"
#include "reproduce/hwang_equations.hpp"
#include "reproduce/hwang_plots.hpp"
#include "reproduce/reproduction.hpp"

/// Hwang, Oh, Kwon and Chu: radial immersion from force drops. Every cut of Table 1 is milled by the plant (edge
/// forces, runout, noise, 300 Hz low-pass, 512 samples a revolution) and estimated from the samples alone.

namespace millforce::sim {

namespace {

using Judged = Figure::Judged;

constexpr double published_error_percent = 10.0;  // section 3.2.2: of every immersion, whatever the cutting conditions

std::vector<TableResult> mill_table(const std::vector<TableRow>& rows, const FittedForceDropLaw& steel,
                                    const FittedForceDropLaw& aluminium) {
    std::vector<TableResult> results;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        results.push_back(mill_row(is_steel(rows[k]) ? steel : aluminium, rows[k], hwang_seed * 50U + k));
    }
    return results;
}

/// NaN as soon as one cut has no estimate at all: nothing is hidden by leaving it out.
double largest_row_error(const TableResult& row) {
    double largest = 0.0;
    for (const TableCut& cut : row) {
        const double error = cut.largest_relative_error();
        largest = std::isfinite(error) && std::isfinite(largest) ? std::max(largest, error) : no_estimate;
    }
    return largest;
}

/// Against the one number that the paper prints about Table 1's cuts: its estimates are within 10 %.
void add_table(const std::vector<TableRow>& rows, const std::vector<TableResult>& results, Reproduction& out) {
    const auto add = [&](const std::string& name, double relative_error) {
        out.figures.push_back(
            {name, "%", published_error_percent, 100.0 * relative_error, Judged::at_most, published_error_percent});
    };
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const std::string name = fmt::format("Table 1 and section 3.2.2, row {} ({}): ", k + 1, describe(rows[k].cut));
        for (const TableCut& cut : results[k]) {
            add(fmt::format("{}error at immersion {:.1f}", name, cut.immersion),
                relative_error(cut.mean(), cut.immersion));
        }
        add(name + "largest error of a single estimate", largest_row_error(results[k]));
    }
}

void add_slope(const HwangLaws& laws, Reproduction& out) {
    out.figures.push_back(
        {"Section 3.2.1, Fig. 7: a of r = a r_av + b, edge force left in", "", 0.50465, laws.steel_without_edges.law.a,
         Judged::within, 1.0, 0.0,
         fmt::format("a belongs to tool and material, by their edge forces and the pressure of thin chips. The paper "
                     "prints neither, so they are assumed here; two others give {:.2f} and {:.2f} (below). What the "
                     "paper's method asks of a is the bound, 0 to 1.",
                     laws.a_at_twice_K_te_without_size_effect, laws.a_at_twice_both_edge_forces)});
}

/// Row 17: 6 inserts, 200 rpm, the immersion growing from 0.2 to 0.8 along 150 mm.
constexpr double part_revolutions = 166.0;

std::vector<ForceDropRun> mill_varying_part(const FittedForceDropLaw& law) {
    const BenchCut cut{.spindle_speed_rpm = 200.0, .teeth = 6, .axial_depth_mm = 1.0, .material = steel_SM45C()};
    const auto immersion_at = [](double revolution) {
        return 0.2 + 0.6 * std::clamp(revolution / part_revolutions, 0.0, 1.0);
    };
    return run_force_drop(law, cut, 1, bench_samples(cut, {.seed = hwang_seed * 17U}, part_revolutions, immersion_at));
}

std::vector<std::string> hwang_deviations() {
    return {
        ("Edge forces are part of the law: F_t = K a (f_z sin φ + e_t). The paper names them as the cause of "
         "its largest error and leaves them in."),
        ("Beside the direction of the drop (Eqs. 6, 11, 12) its size relative to the average force is used; "
         "the two estimates are joined by their variances, and refused where they disagree."),
        ("Equation 6 by the two-argument arctangent, and every root by a bracket: the printed tan⁻¹ fails past "
         "90°, and the printed iteration is proven for a up to 1 only."),
        ("With the edge force taken out r hardly varies and the slope a is nearly undetermined, even negative. "
         "With it left in a is positive and below 1, as the paper's 0.50465, whose value belongs to its tool."),
        ("The drop is read by fitting the low-pass's own response on either side of the jump, where the paper "
         "takes the difference before and after."),
        ("The forces' zero is read between two teeth, where none is in cut."),
        ("Six inserts at immersion 0.5: one tooth enters where another leaves; the entering tooth's share is "
         "found with the immersion, and where several immersions explain the signal there is no estimate (in "
         "down milling always)."),
        ("Table 1 prints the feed per tooth in mm/min: read mm. Figure 5 shows two inserts in cut, not more. "
         "The geometry of the varying part cannot be read from Fig. 15: immersion grows evenly over 150 mm "
         "here."),
        ("The text at Fig. 1 lets the angle grow with F_Y/F_X. By Eq. 6 it falls, as the text at Fig. 2 has it for the "
         "average forces."),
        ("Eq. 14 is missing from the text that this project has: it is derived here from Eqs. 11 and 12. By it the "
         "paper's iteration converges even for a up to 1.5, where r and r_av are alike."),
        ("From feed drives: current and acceleration of the axis together; the current alone follows a "
         "velocity loop of 60 Hz. Both axes must move, in one direction, throughout the revolution."),
    };
}

constexpr const char* hwang_summary =
    "When a tooth of a face mill leaves the workpiece, the force drops at once by what that tooth carried. From this "
    "drop and from the average force of a revolution the system finds how wide the cut is: its radial immersion, the "
    "width over the cutter's radius. It needs neither the material's hardness nor the depth of cut. Every cut of the "
    "paper's Table 1 is milled here in simulation, with edge forces, runout, noise and a 300 Hz filter before the "
    "samples, and estimated from these samples alone.";

std::vector<NotReproduced> hwang_not_reproduced() {
    return {
        {"Figs. 7 and 9–15, measured points",
         "the text that this project has holds no images, and the paper prints no table of them. Drawn instead: our "
         "simulated cuts, and the printed slope of Fig. 7. Judged instead: the printed 10 %."},
        {"Figs. 6 and 8", "a sketch of the bench and a flow chart: they show no data."},
    };
}

}  // namespace

Reproduction reproduce_hwang() {
    Reproduction out;
    out.name = "hwang";
    out.title = "Radial immersion from force drops (Hwang, Oh, Kwon, Chu)";
    out.source = {
        "J. H. Hwang, Y. T. Oh, W. T. Kwon, C. N. Chu: In-process estimation of radial immersion ratio in face milling "
        "using cutting force. The International Journal of Advanced Manufacturing Technology 22 (2003) 313–320."};
    out.summary = hwang_summary;
    const HwangLaws laws = calibrated_laws();
    const std::vector<TableRow> rows = table_rows();
    const auto ours = mill_table(rows, laws.steel.law, laws.aluminium.law);
    const auto without = mill_table(rows, laws.steel_without_edges.law, laws.aluminium_without_edges.law);
    const auto varying = mill_varying_part(laws.steel.law);
    const DriveResult drives = mill_on_drives(laws.steel.law);
    constexpr std::size_t six_inserts = 10;
    const auto threshold_points = thresholds(ours[six_inserts], rows[six_inserts].cut, laws.steel);

    add_table(rows, ours, out);
    add_slope(laws, out);
    add_convergence(out);
    check_table(ours, out);
    check_other_seeds(rows, laws, out);
    check_other_plants(out);
    check_varying_part(varying, out);
    check_edges(ours, without, out);
    check_laws(laws, out);
    check_down_milling(laws, out);
    check_drives(drives, out);
    check_thresholds(threshold_points, out);

    add_equation_plots(laws.steel_cuts, out);
    add_signal_plots(hwang_seed, out);
    add_slope_plot(laws, out);
    add_table_plots(rows, ours, out);
    add_varying_plot(varying, out);
    add_edge_plot(ours, without, out);
    add_drive_plot(drives.diagonal, out);
    add_threshold_plot(threshold_points, out);
    out.deviations = hwang_deviations();
    out.not_reproduced = hwang_not_reproduced();
    return out;
}

}  // namespace millforce::sim
