// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace millforce::sim {

namespace {

using Judged = Figure::Judged;

/// NaN as soon as one cut has no estimate at all: nothing is hidden by leaving it out.
double largest_cut_error(const std::vector<TableCut>& cuts, double largest_so_far = 0.0) {
    double largest = largest_so_far;
    for (const TableCut& cut : cuts) {
        const bool is_known = std::isfinite(cut.mean()) && std::isfinite(largest);
        largest = is_known ? std::max(largest, relative_error(cut.mean(), cut.immersion)) : no_estimate;
    }
    return largest;
}

double largest_cut_error(const std::vector<TableResult>& results) {
    double largest = 0.0;
    for (const TableResult& row : results) {
        largest = largest_cut_error(row, largest);
    }
    return largest;
}

}  // namespace

void check_table(const std::vector<TableResult>& results, Reproduction& out) {
    const ForceDropTally tally = tally_of(results);
    out.checks.push_back(
        own_check("Mean error over all cuts of Table 1", "", mean_error(results, 0.0), Judged::at_most, 0.03));
    out.checks.push_back(own_check("Mean error at immersion 0.2, where the paper is worst", "",
                                   mean_error(results, 0.2), Judged::at_most, 0.03));
    out.checks.push_back(own_check("Share of revolutions with an estimate", "", tally.share(), Judged::at_least, 0.97));
    out.checks.push_back(own_check("Share of estimates within two of their standard deviations", "", tally.coverage(),
                                   Judged::within, 1.0, 0.93));
}

void check_other_seeds(const std::vector<TableRow>& rows, const HwangLaws& laws, Reproduction& out) {
    constexpr std::size_t seeds = 3;
    std::vector<TableResult> results;
    for (std::size_t k = 0; k < seeds * rows.size(); ++k) {
        const TableRow& row = rows[k % rows.size()];
        results.push_back(mill_row(is_steel(row) ? laws.steel.law : laws.aluminium.law, row, 1000U + k));
    }
    out.checks.push_back(
        own_check("Three other seeds: mean error", "", mean_error(results, 0.0), Judged::at_most, 0.03));
    out.checks.push_back(own_check("Three other seeds: mean error at immersion 0.2", "", mean_error(results, 0.2),
                                   Judged::at_most, 0.03));
    out.checks.push_back(
        own_check("Three other seeds: largest error of a cut", "", largest_cut_error(results), Judged::at_most, 0.10));
    out.checks.push_back(
        own_check("Three other seeds: largest error of a single estimate", "", tally_of(results).largest()));
}

namespace {

void check_other_plant(const std::string& name, const BenchMaterial& material, double runout_mm, Reproduction& out) {
    const FittedForceDropLaw law = calibration_of(calibration_cuts(material, true, hwang_seed + 2U)).solve().law;
    std::vector<TableResult> results;
    std::uint64_t seed = 77U;
    for (TableRow row : table_rows()) {
        row.cut.material = material;
        row.cut.runout_mm = runout_mm;
        results.push_back(mill_row(law, row, ++seed));
    }
    out.checks.push_back(
        own_check(name + ": mean error over the rows of Table 1", "", mean_error(results, 0.0), Judged::at_most, 0.03));
}

}  // namespace

void check_other_plants(Reproduction& out) {
    constexpr double usual_runout_mm = 0.008;
    BenchMaterial power_law = steel_SM45C();
    power_law.coefficients.K_te_N_mm = 0.0;
    power_law.coefficients.K_re_N_mm = 0.0;
    power_law.coefficients.size_effect.tangential_exponent = -0.2557;  // Kim & Chung, of the instantaneous chip here
    power_law.coefficients.size_effect.radial_exponent = -0.2557 - 0.1546;
    check_other_plant("Pressure by Kim & Chung's exponents, no edge force", power_law, usual_runout_mm, out);
    check_other_plant("Runout 20 µm", steel_SM45C(), 0.020, out);
}

void check_edges(const std::vector<TableResult>& ours, const std::vector<TableResult>& without, Reproduction& out) {
    const auto by_direction = [](const std::vector<TableResult>& results) {
        double sum = 0.0;
        int count = 0;
        for (const TableResult& row : results) {
            for (const ForceDropRun& run : row.front().runs) {
                const auto& root = run.estimate.by_direction;
                sum += root.valid ? relative_error(static_cast<double>(root.immersion()), run.immersion) : 0.0;
                count += root.valid ? 1 : 0;
            }
        }
        return count > 0 ? sum / count : no_estimate;
    };
    const double taken_out = by_direction(ours);
    const double left_in = by_direction(without);
    out.checks.push_back(
        own_check("Immersion 0.2, Eqs. 6, 11, 12 alone, edge force left in: mean error of an estimate", "", left_in));
    out.checks.push_back(own_check("Immersion 0.2, the same with the edge force taken out: mean error of an estimate",
                                   "", taken_out, Judged::at_most, 0.5 * left_in));
}

void check_laws(const HwangLaws& laws, Reproduction& out) {
    const auto& plain = laws.steel_without_edges.law;
    const auto& law = laws.steel.law;
    const auto show = [&](const char* name, const char* unit, double value) {
        out.checks.push_back(own_check(name, unit, value));
    };
    show("Fig. 7: standard error of our a", "", std::sqrt(plain.a_b_covariance(0, 0)));
    show("Fig. 7: b, edge force left in (the paper prints none)", "", plain.b);
    show("Fig. 7: a of Al 6061 on the same bench, edge force left in", "", laws.aluminium_without_edges.law.a);
    show("Fig. 7: a of SM45C with twice the edge force K_te and no size effect", "",
         laws.a_at_twice_K_te_without_size_effect);
    show("Fig. 7: a of SM45C with twice both edge forces", "", laws.a_at_twice_both_edge_forces);
    show("a of SM45C, edge force taken out", "", law.a);
    show("its standard error", "", std::sqrt(law.a_b_covariance(0, 0)));
    show("Edge length e_t of SM45C", "mm", law.e_t_mm);
    show("Edge length e_r of SM45C", "mm", law.e_r_mm);
    out.checks.push_back(own_check("Edge length e_t of SM45C, relative standard error", "", law.e_t_sd_mm / law.e_t_mm,
                                   Judged::at_most, 0.10));
}

void check_varying_part(const std::vector<ForceDropRun>& runs, Reproduction& out) {
    ForceDropTally tally;
    std::for_each(runs.begin(), runs.end(), [&](const ForceDropRun& run) { tally.add(run); });
    out.checks.push_back(
        own_check("Table 1, row 17 (varying immersion, 6 inserts), mean error of an estimate per revolution", "",
                  tally.mean_error(), Judged::at_most, 0.03));
    out.checks.push_back(own_check("Table 1, row 17, largest error", "", tally.largest(), Judged::at_most, 0.10));
    out.checks.push_back(
        own_check("Table 1, row 17, share of revolutions with an estimate", "", tally.share(), Judged::at_least, 0.85));
}

void check_down_milling(const HwangLaws& laws, Reproduction& out) {
    std::vector<TableResult> results;
    std::uint64_t seed = hwang_seed * 90U;
    for (TableRow row : table_rows()) {
        row.cut.up_milling = false;
        if (is_steel(row) && row.cut.teeth < 6) {
            results.push_back(mill_row(laws.steel_down.law, row, ++seed));
        }
    }
    out.checks.push_back(own_check("Down milling, jump at entry: mean error over the same conditions", "",
                                   mean_error(results, 0.0), Judged::at_most, 0.03));
    out.checks.push_back(
        own_check("Down milling: largest error of a cut", "", largest_cut_error(results), Judged::at_most, 0.10));
}

namespace {

DriveCut drive_cut_at(double immersion, double rpm, double direction_rad, std::uint64_t seed) {
    DriveCut drive_cut;
    drive_cut.cut = {
        .spindle_speed_rpm = rpm, .teeth = 3, .axial_depth_mm = 1.0, .material = steel_SM45C(), .immersion = immersion};
    drive_cut.feed_direction_rad = direction_rad;
    drive_cut.seed = seed;
    return drive_cut;
}

}  // namespace

DriveResult mill_on_drives(const FittedForceDropLaw& law) {
    constexpr double diagonal_rad = 0.785398;
    constexpr double beyond_bandwidth_rpm = 2000.0;  // 100 teeth a second
    DriveResult result;
    std::uint64_t seed = hwang_seed * 300U;
    for (const double immersion : table_immersions) {
        const auto run = [&](double rpm, double direction_rad) {
            const DriveCut drive_cut = drive_cut_at(immersion, rpm, direction_rad, ++seed);
            return run_force_drop_on_drives(law, drive_cut, revolutions_per_estimate, drive_recording(drive_cut));
        };
        result.diagonal.push_back({immersion, run(200.0, diagonal_rad)});
        for (const ForceDropRun& one : result.diagonal.back().runs) {
            result.inside.add(one);
        }
        for (const ForceDropRun& one : run(beyond_bandwidth_rpm, diagonal_rad)) {
            result.too_fast.add(one);
        }
        for (const ForceDropRun& one : run(200.0, 0.0)) {
            result.along_x.add(one);
        }
    }
    return result;
}

void check_drives(const DriveResult& drives, Reproduction& out) {
    out.checks.push_back(own_check("Feed drives, 200 rpm × 3 inserts, both axes moving: mean error of an estimate", "",
                                   drives.inside.mean_error(), Judged::at_most, 0.03));
    out.checks.push_back(own_check("Feed drives: largest error of a cut, 20–80 %", "",
                                   largest_cut_error(drives.diagonal), Judged::at_most, 0.10));
    out.checks.push_back(own_check("Feed drives: share of revolutions with an estimate", "", drives.inside.share(),
                                   Judged::at_least, 0.9));
    out.checks.push_back(own_check("Feed drives, 2000 rpm × 3 inserts, beyond their bandwidth: estimates given", "",
                                   drives.too_fast.estimates, Judged::at_most, 0.0));
    out.checks.push_back(own_check("Feed drives, feed along x, the y axis standing: estimates given", "",
                                   drives.along_x.estimates, Judged::at_most, 0.0));
}

/// At immersion 0.5 the next tooth's edge force comes in at once: the threshold has a step there, and an estimate that
/// is 0.01 too large is on its other side. That point is judged by the cautious threshold alone.
void check_thresholds(const std::vector<ThresholdPoint>& points, Reproduction& out) {
    constexpr double step_at = 0.5;
    double largest = 0.0;
    double largest_excess = -1.0;
    for (const ThresholdPoint& point : points) {
        largest_excess = std::max(largest_excess, point.cautious / point.truth - 1.0);
        largest =
            point.immersion == step_at ? largest : std::max(largest, relative_error(point.estimated, point.truth));
    }
    out.checks.push_back(
        own_check("Threshold of the total force per tooth's limit, 6 inserts, 0.2–0.8 but 0.5: largest error", "",
                  largest, Judged::at_most, 0.05));
    out.checks.push_back(
        own_check("Threshold at two standard deviations below the estimate: largest excess over the true one", "",
                  largest_excess, Judged::at_most, 0.02));
    out.checks.push_back(own_check("Threshold at immersion 0.8 over that at 0.2: what a fixed one would give away", "",
                                   points.back().estimated / points.front().estimated, Judged::at_least, 1.2));
}

}  // namespace millforce::sim
