// SPDX-License-Identifier: Apache-2.0
#include "reproduce/kim_campaign.hpp"
#include "reproduce/kim_plots.hpp"
#include "reproduce/reproduction.hpp"

#include "cutting/revolution_load.hpp"
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation/engagement/engagement_solver_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

/// Kim & Chung: what the paper prints, its averages against the plant's integration, and its three steps on simulated
/// machines.

namespace millforce::sim {
namespace kim_reproduction {
namespace {

using Judged = Figure::Judged;
using estimation::CutSide;

constexpr double not_printed = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t machines = 12;

constexpr double standard_feed_per_tooth_mm =
    KimStandardCut::feed_mm_min / (KimStandardCut::flutes * KimStandardCut::spindle_rpm);
constexpr double radius_mm = 0.5 * KimStandardCut::diameter_mm;

/// Tables 2, 4 and 5.
struct PublishedTool {
    const char* name;
    const char* table;
    AverageChipLaw law;
    double k_s_by_currents;
    double p_s_by_currents;
};

const std::array<PublishedTool, 2>& tools() {
    static const std::array<PublishedTool, 2> published{{
        {"carbide", "Table 2", {1007.59, -0.2557, 0.2242, -0.1546}, 1052.96, -0.2403},
        {"HSS", "Table 4", {831.16, -0.2749, 0.1526, -0.2227}, 703.26, -0.3176},
    }};
    return published;
}

void add_table_1(Reproduction& result) {
    auto& figures = result.figures;
    figures.push_back({"Table 1: cutting speed", "m/min", 31.6673,
                       std::numbers::pi * KimStandardCut::diameter_mm * KimStandardCut::spindle_rpm / 1000.0,
                       Judged::difference, 1e-4});
    figures.push_back({"Table 1: feed per tooth", "mm", 0.0496, standard_feed_per_tooth_mm, Judged::difference, 5e-5});
    figures.push_back({"Table 1: volume removed per tooth", "mm³", 0.4762,
                       standard_feed_per_tooth_mm * KimStandardCut::radial_width_mm * KimStandardCut::axial_depth_mm,
                       Judged::difference, 5e-5});
}

estimation::CutConditions<double> conditions(double radial_immersion, CutSide side, double feed_per_tooth_mm) {
    return {feed_per_tooth_mm, KimStandardCut::axial_depth_mm, estimation::engagement_angles(side, radial_immersion),
            static_cast<double>(KimStandardCut::flutes)};
}

/// Eq. 4 in the paper's symbols, with R_a where it prints R_r, φ_r where it prints φ_N.
estimation::AverageForces<double> by_equation_4(const AverageChipLaw& law, double R_r, double t_c) {
    constexpr double tan_beta = 0.5;  // cancels
    const double R = radius_mm;
    const double R_a = KimStandardCut::axial_depth_mm / R;
    const double phi_N = 2.0 * std::numbers::pi / KimStandardCut::flutes;
    const double phi_r = std::acos(R_r - 1.0);  // entry angle
    const double t_a = t_c * R_r / (std::numbers::pi - phi_r);
    const double K = law.k_s * std::pow(t_a, law.p_s) * R * t_c / tan_beta;
    const double r_1 = law.k_1 * std::pow(t_a, law.p_1);
    const double A_r = tan_beta / (2.0 * phi_N) * (R_r * R_r - 2.0 * R_r);
    const double B_r =
        tan_beta / (2.0 * phi_N) * ((R_r - 1.0) * std::sqrt(2.0 * R_r - R_r * R_r) - phi_r + std::numbers::pi);
    const double C_r = tan_beta / phi_N * R_r;
    return {K * R_a * C_r, K * R_a * (A_r + r_1 * B_r), K * R_a * (-B_r + r_1 * A_r)};
}

/// The plant's mean forces of the same cut, from edge elements.
estimation::AverageForces<double> by_integration(const AverageChipLaw& law,
                                                 const estimation::CutConditions<double>& cut) {
    Cutter cutter;
    cutter.teeth = KimStandardCut::flutes;
    cutter.diameter_mm = KimStandardCut::diameter_mm;
    cutter.flute_length_mm = 19.0;
    cutter.helix_rad = std::numbers::pi / 6.0;
    const double t_a = estimation::mean_chip_thickness_mm(cut.feed_per_tooth_mm, cut.engagement);
    const CuttingForce force(cutter, coefficients_at(law, t_a),
                             {.chip_model = ChipModel::circular, .resolution = {.largest_angle_per_slice_rad = 0.01}});
    const RevolutionLoad load = revolution_load(
        force, cut.feed_per_tooth_mm,
        uniform_engagement(cut.engagement.entry_rad, cut.engagement.exit_rad, cut.axial_depth_mm), 0.003);
    return {load.mean_torque_Nm * 1000.0 / radius_mm, load.mean_fx_N, load.mean_fy_N};
}

void add_average_forces(Reproduction& result) {
    const AverageChipLaw& law = tools()[0].law;
    double of_equation_4 = 0.0;
    double of_integration = 0.0;
    double up_of_integration = 0.0;
    const auto apart = [](const auto& a, const auto& b) {
        return std::hypot(a.tangential_N - b.tangential_N, a.feed_N - b.feed_N, a.normal_N - b.normal_N) /
               std::abs(b.tangential_N);
    };
    for (const double R_r : {0.05, 0.1, 0.2, 0.35, 0.5, 0.8, 1.0, 1.3, 1.6, 2.0}) {
        for (const double f_z : {0.02, 0.0496, 0.139}) {
            const auto down = conditions(R_r, CutSide::down, f_z);
            const auto up = conditions(R_r, CutSide::up, f_z);
            const auto closed = estimation::average_forces(closed_law(law), down);
            of_equation_4 = std::max(of_equation_4, apart(by_equation_4(law, R_r, f_z), closed));
            of_integration = std::max(of_integration, apart(by_integration(law, down), closed));
            up_of_integration = std::max(
                up_of_integration, apart(by_integration(law, up), estimation::average_forces(closed_law(law), up)));
        }
    }
    auto& figures = result.figures;
    figures.push_back(
        {"Eq. 4 with R_a and φ_r in their places, against the closed averages for any engagement: largest "
         "deviation over F_at, 30 cuts, down milling",
         "", not_printed, of_equation_4, Judged::at_most, 1e-9});
    figures.push_back(
        {"Eq. 4 against the plant's integration of edge elements: largest deviation, 30 cuts, down milling", "%",
         not_printed, 100.0 * of_integration, Judged::at_most, 0.02});
    figures.push_back({"The same averages in up milling, which the paper leaves out", "%", not_printed,
                       100.0 * up_of_integration, Judged::at_most, 0.02});
    const auto standard = by_integration(law, conditions(0.2, CutSide::down, standard_feed_per_tooth_mm));
    const auto closed =
        estimation::average_forces(closed_law(law), conditions(0.2, CutSide::down, standard_feed_per_tooth_mm));
    figures.push_back({"Standard cut: F_at by integration, against the closed average", "N", closed.tangential_N,
                       standard.tangential_N, Judged::difference, 0.1});
    figures.push_back({"Standard cut: F_ax", "N", closed.feed_N, standard.feed_N, Judged::difference, 0.1});
    figures.push_back({"Standard cut: F_ay", "N", closed.normal_N, standard.normal_N, Judged::difference, 0.1});
    const auto widest = by_integration(law, conditions(0.5, CutSide::down, 700.0 / 5040.0));
    figures.push_back(
        {"Section 3.1: largest average force of its feeds (to 700 mm/min) and widths (to 2 mm), designed not "
         "to exceed 1000 N",
         "N", 1000.0, widest.tangential_N, Judged::shown});
}

/// Eq. 6: where the ratio determines the immersion, and where it does not.
void add_force_ratio(Reproduction& result) {
    const AverageChipLaw& law = tools()[0].law;
    const auto ratio = [&](CutSide side, double R_r) {
        const auto forces = by_integration(law, conditions(R_r, side, standard_feed_per_tooth_mm));
        return forces.feed_N / forces.tangential_N;
    };
    bool monotone = true;
    double last = -std::numeric_limits<double>::infinity();
    for (int k = 1; k <= 40; ++k) {
        const double now = ratio(CutSide::down, 0.05 * k);
        monotone = monotone && now > last;
        last = now;
    }
    const auto change = [&](CutSide side) {
        double lowest = std::numeric_limits<double>::infinity();
        double highest = -lowest;
        for (int k = 5; k <= 20; ++k) {
            const double R_r = 0.01 * k;
            lowest = std::min(lowest, ratio(side, R_r));
            highest = std::max(highest, ratio(side, R_r));
        }
        return highest - lowest;
    };
    result.figures.push_back({"Eq. 6: F_ax/F_at grows with the immersion throughout in down milling (1: yes)", "",
                              not_printed, monotone ? 1.0 : 0.0, Judged::at_least, 1.0});
    result.figures.push_back(
        {"Eq. 6: change of F_ax/F_at from R_r 0.05 to 0.2 in up milling, as a share of that in down "
         "milling: it tells hardly any immersion there",
         "", not_printed, change(CutSide::up) / change(CutSide::down), Judged::at_most, 0.1});
}

/// Values calculated outside the program, by disc integration of Eqs. 2 and 3 at f_z 0.0496 mm.
void add_check_values(Reproduction& result) {
    struct Forces {
        double R_r, F_at, F_ax, F_ay;
    };
    constexpr double f_z = 0.0496;
    const AverageChipLaw& law = tools()[0].law;
    double largest_N = 0.0;
    for (const Forces& check :
         {Forces{0.2, 221.92, -160.96, -176.06}, {1.0, 923.72, -184.36, -902.15}, {2.0, 1847.44, 555.00, -1450.98}}) {
        const auto forces = estimation::average_forces(closed_law(law), conditions(check.R_r, CutSide::down, f_z));
        for (const double error :
             {forces.tangential_N - check.F_at, forces.feed_N - check.F_ax, forces.normal_N - check.F_ay}) {
            largest_N = std::max(largest_N, std::abs(error));
        }
    }
    struct Ratio {
        CutSide side;
        double R_r, F_ax_over_F_at;
    };
    double largest_ratio = 0.0;
    for (const Ratio& check : {Ratio{CutSide::down, 0.05, -0.876},
                               {CutSide::down, 0.2, -0.725},
                               {CutSide::down, 0.5, -0.504},
                               {CutSide::down, 1.0, -0.200},
                               {CutSide::down, 1.5, 0.066},
                               {CutSide::down, 2.0, 0.300},
                               {CutSide::up, 0.05, 1.0743},
                               {CutSide::up, 0.2, 1.0747},
                               {CutSide::up, 0.5, 0.996},
                               {CutSide::up, 1.0, 0.800},
                               {CutSide::up, 2.0, 0.300}}) {
        const auto forces = estimation::average_forces(closed_law(law), conditions(check.R_r, check.side, f_z));
        largest_ratio = std::max(largest_ratio, std::abs(forces.feed_N / forces.tangential_N - check.F_ax_over_F_at));
    }
    result.figures.push_back({"Eq. 4: largest deviation of nine forces (a_e 0.8, 4, 8 mm) from disc integration", "N",
                              not_printed, largest_N, Judged::at_most, 0.02});
    result.figures.push_back({"Eq. 6: largest deviation of eleven force ratios, down and up, from disc integration", "",
                              not_printed, largest_ratio, Judged::at_most, 0.001});
}

void add_drive_equations(Reproduction& result) {
    constexpr double K_t1 = 196.61;
    constexpr double K_t2 = -1911.0;
    estimation::SpindleDriveParameters<double> spindle;
    spindle.K_t1_Nm_per_A = K_t1 * radius_mm / 1000.0;
    spindle.K_t2_Nm = K_t2 * radius_mm / 1000.0;
    const estimation::SpindleDrive<double> spindle_drive(spindle);
    const auto F_at = [&](double current) {
        return spindle_drive.tangential_force_N({current, 131.9, 0.0, 0.0, 1.0, true}, radius_mm).value;
    };
    estimation::FeedDriveParameters<double> feed;
    feed.positive = {3.5788, -7.2469};
    feed.K_x3_A = 19.7252;
    feed.K_x4_N_per_A = K_t1;
    feed.K_x5_N_m_per_min = K_t2;
    const estimation::FeedDrive<double> feed_drive(feed);
    constexpr double w = 0.25;
    const double I_axf = (3.5788 * w - 7.2469) * w + 19.7252;
    auto& figures = result.figures;
    figures.push_back({"Eq. 8 with its constants: F_at at 12 units of current", "N", K_t1 * 12.0 + K_t2, F_at(12.0),
                       Judged::difference, 1e-6});
    figures.push_back({"Eq. 8: current of the idle spindle, −K_t2/K_t1", "", not_printed, -K_t2 / K_t1, Judged::shown});
    figures.push_back(
        {"Eqs. 9 and 10 with Table 3: F_ax at 0.25 m/min where the current is friction's alone: K_x4 and K_x5 "
         "repeat Eq. 8",
         "N", K_t2 / w, feed_drive.force_N({I_axf, w / 0.06, 0.0, 1.0, 1.0, true}).value, Judged::difference, 1e-6});
}

/// Over all machines: errors, and how many lie within two standard errors.
struct Tally {
    double largest = 0.0;
    int within = 0;

    void add(double error, double standard_error, double truth) {
        largest = std::max(largest, std::abs(error / truth));
        within += std::abs(error) <= 2.0 * standard_error ? 1 : 0;
    }
};

void add_gains(const std::vector<KimCampaign>& campaigns, Reproduction& result) {
    Tally spindle;
    Tally feed;
    Tally idle;
    for (const KimCampaign& c : campaigns) {
        const auto& x = *c.gains.axes[0];
        spindle.add(c.gains.spindle.gain - c.machine.torque_constant_Nm_per_A, c.gains.spindle.gain_se,
                    c.machine.torque_constant_Nm_per_A);
        idle.add(c.gains.spindle.offset + c.idle_torque_Nm, c.gains.spindle.offset_se, c.idle_torque_Nm);
        feed.add(x.gain - c.machine.force_constant_N_per_A, x.gain_se, c.machine.force_constant_N_per_A);
    }
    auto& figures = result.figures;
    const auto add = [&](const std::string& what, const Tally& tally, double bound) {
        figures.push_back({fmt::format("Step 2: {} by standard cuts, largest error over {} machines", what, machines),
                           "%", not_printed, 100.0 * tally.largest, Judged::at_most, bound});
    };
    add("K_t1", spindle, 1.0);
    add("K_t2, the warm idle torque,", idle, 3.0);
    add("K_x4", feed, 1.5);
    const double within = spindle.within + idle.within + feed.within;
    figures.push_back(
        {"Step 2: K_t1, K_t2 and K_x4 within two standard errors (Student's t, 10 degrees of freedom: 93 %)", "%",
         not_printed, 100.0 * within / (3.0 * static_cast<double>(machines)), Judged::within, 100.0, 85.0});
    figures.push_back({"Step 2: K_x5 of the first machine: what the quadratic friction leaves at low feed, and no more",
                       "N·m/min", not_printed, campaigns.front().gains.axes[0]->offset, Judged::shown});
}

void add_coefficients(const PublishedTool& tool, const std::vector<KimUnknownTool>& found, Reproduction& result) {
    Tally k_s;
    Tally p_s;
    Tally k_1;
    Tally p_1;
    for (const KimUnknownTool& t : found) {
        const auto& fit = t.fit;
        k_s.add(fit.law.k_s_N_per_mm2 - tool.law.k_s, fit.k_s_standard_error(), tool.law.k_s);
        p_s.add(fit.law.p_s - tool.law.p_s, fit.standard_error(estimation::cutting_p_s), tool.law.p_s);
        k_1.add(fit.law.k_1 - tool.law.k_1, fit.k_1_standard_error(), tool.law.k_1);
        p_1.add(fit.law.p_1 - tool.law.p_1, fit.standard_error(estimation::cutting_p_1), tool.law.p_1);
    }
    const auto& first = found.front().fit;
    auto& figures = result.figures;
    const auto from_currents = [&](const char* what, double published, double ours, double se, double bound) {
        figures.push_back(
            {fmt::format("{}, {}: {} from currents alone (standard error {:.2g})", tool.table, tool.name, what, se), "",
             published, ours, Judged::relative_difference, bound});
    };
    from_currents("k_s", tool.law.k_s, first.law.k_s_N_per_mm2, first.k_s_standard_error(), 0.045);
    from_currents("p_s", tool.law.p_s, first.law.p_s, first.standard_error(estimation::cutting_p_s), 0.06);
    from_currents("k_1", tool.law.k_1, first.law.k_1, first.k_1_standard_error(), 0.045);
    from_currents("p_1", tool.law.p_1, first.law.p_1, first.standard_error(estimation::cutting_p_1), 0.06);
    const auto worst = [&](const char* what, const Tally& tally, double printed, double bound) {
        figures.push_back(
            {fmt::format("Table 5, {}: largest deviation of {} over {} machines (printed: the paper's one)", tool.name,
                         what, machines),
             "%", printed, 100.0 * tally.largest, Judged::at_most, bound});
    };
    worst("k_s", k_s, 100.0 * std::abs(tool.k_s_by_currents / tool.law.k_s - 1.0), 4.5);
    worst("p_s", p_s, 100.0 * std::abs(tool.p_s_by_currents / tool.law.p_s - 1.0), 6.0);
    worst("k_1 (the paper prints none)", k_1, not_printed, 4.5);
    worst("p_1 (the paper prints none)", p_1, not_printed, 6.0);
    const double within = k_s.within + p_s.within + k_1.within + p_1.within;
    figures.push_back({fmt::format("Step 3, {}: coefficients within two standard errors, {} machines (Student's t, 8 "
                                   "degrees of freedom: 92 %)",
                                   tool.name, machines),
                       "%", not_printed, 100.0 * within / (4.0 * static_cast<double>(machines)), Judged::within, 100.0,
                       85.0});
}

/// Immersion and depth of new cuts, by the coefficients and gains that the machine found itself.
struct EngagementTally {
    double immersion_squares = 0.0;
    double depth_squares = 0.0;
    int immersion_within = 0;
    int depth_within = 0;
    int count = 0;
};

std::vector<KimCut> new_cuts() {
    return {{150.0, 0.6, 10.0}, {250.0, 1.2, 8.0}, {300.0, 2.4, 6.0}, {200.0, 3.2, 6.0},
            {250.0, 4.0, 5.0},  {200.0, 5.2, 4.0}, {150.0, 6.4, 4.0}, {150.0, 8.0, 3.0}};
}

estimation::AverageForceMeasurement<double> measured_forces(const host::CutRow& row,
                                                            const host::RecordedStretch& stretch,
                                                            const KimCampaign& campaign) {
    const auto& gains = campaign.gains;
    const double per_root_s = std::sqrt(1.5 / stretch.duration_s);  // that of the cut and half of each air stretch
    const double torque_sd = gains.spindle.gain * gains.spindle.residual_A * per_root_s;
    const double force_sd = gains.axes[0]->gain * gains.axes[0]->residual_A * per_root_s;
    const double F_at = row.spindle_torque_Nm * 1000.0 / radius_mm;
    const auto square = [](double value) { return value * value; };
    estimation::AverageForceMeasurement<double> m;
    m.tangential_N = {
        true, F_at, square(torque_sd * 1000.0 / radius_mm) + square(campaign.gain_doubt.tangential_relative_sd * F_at),
        0.0};
    m.x_N = {true, row.feed_force_N, square(force_sd) + square(campaign.gain_doubt.feed_relative_sd * row.feed_force_N),
             0.0};
    return m;
}

void tally_engagements(const KimCampaign& campaign, const KimUnknownTool& tool, const AverageChipLaw& law,
                       EngagementTally& tally) {
    const auto stretches = simulate_cuts(campaign.machine, law, new_cuts(), 7);
    const auto rows = host::forces_of_cuts(stretches, campaign.calibrated);
    estimation::EngagementSolverSettings<double> settings;
    settings.teeth = KimStandardCut::flutes;
    const estimation::EngagementSolver<double> solver(tool.fit.law, settings);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto found = solver.solve(measured_forces(rows[k], stretches[2 * k + 1], campaign),
                                        rows[k].feed_per_tooth_mm(), CutSide::down);
        const double R_r = rows[k].radial_width_mm / radius_mm;
        const double depth = rows[k].axial_depth_mm;
        tally.immersion_squares += std::pow(found.radial_immersion - R_r, 2.0);
        tally.depth_squares += std::pow(found.axial_depth_mm / depth - 1.0, 2.0);
        tally.immersion_within += found.radial_immersion_low <= R_r && R_r <= found.radial_immersion_high ? 1 : 0;
        tally.depth_within += std::abs(found.axial_depth_mm - depth) <= 1.96 * found.axial_depth_sd_mm ? 1 : 0;
        ++tally.count;
    }
}

void add_engagement(const std::vector<KimCampaign>& campaigns, const std::vector<KimUnknownTool>& tools_found,
                    const AverageChipLaw& law, Reproduction& result) {
    constexpr std::size_t few = 5;
    EngagementTally tally;
    for (std::size_t k = 0; k < few; ++k) {
        tally_engagements(campaigns[k], tools_found[k], law, tally);
    }
    const double count = tally.count;
    auto& figures = result.figures;
    figures.push_back({fmt::format("Eq. 6: radial immersion of {} new cuts (0.15 to 2), error rms", tally.count), "",
                       not_printed, std::sqrt(tally.immersion_squares / count), Judged::at_most, 0.05});
    figures.push_back({"Eq. 7: their axial depth, relative error rms", "%", not_printed,
                       100.0 * std::sqrt(tally.depth_squares / count), Judged::at_most, 5.0});
    figures.push_back({"Eqs. 6 and 7: 95 % intervals that hold the truth", "%", not_printed,
                       100.0 * (tally.immersion_within + tally.depth_within) / (2.0 * count), Judged::at_least, 90.0});
}

std::vector<std::string> deviations() {
    return {
        ("Eq. 4 prints R_r before the brackets of F_ax and F_ay; integration of the edge elements gives R_a. In B_r "
         "the "
         "printed φ_N is the entry angle φ_r."),
        ("Table 3 prints K_x4 = 196.61 and K_x5 = −1911.00: K_t1 and K_t2 of Eq. 8 to the digit. With them F_ax is "
         "−7644 N "
         "at 0.25 m/min where the axis only overcomes its friction. Here both are calibrated, by standard cuts."),
        ("Section 3.3 refers to Tables 3 and 4 for the coefficients; they stand in Tables 2 and 4. Fig. 5 and Fig. 6 "
         "give no "
         "unit of current; here: ampere."),
        ("The tangential force of its largest feed and width is some 1070 N by its own coefficients, not below 1000 "
         "N."),
        ("The paper's forces for the comparison come from a dynamometer. Here the plant's cutting force has the "
         "published "
         "law, and between it and the coefficients stand the simulated drives: inertia, friction with pre-sliding and "
         "Stribeck's fall at low feed, ripple over the screw's pitch, noise of 1 % of the rated current, quantisation "
         "to a "
         "per mille, and a bearing that warms up."),
        ("The helix is not printed: 30°. At 12 mm depth its lag is a tooth pitch, and the force hardly ripples."),
        ("Each cut has running in air at its own feed before it: idle current and friction are taken from there, not "
         "from "
         "Eqs. 8 and 9 of another day. So r_1 comes out as well, where the paper finds large errors."),
        ("In the plant K_x5 has no counterpart. What the fit gives is what the quadratic of Eq. 9 leaves of Stribeck's "
         "friction at the lowest feed."),
        ("The plant's chip is the paper's, f_z sin φ. With the trochoidal chip over the same engagement angles the "
         "force of a "
         "cut 0.2 mm wide at 0.14 mm per tooth is 9 % higher, because such a cut removes more than f_z a_e."),
        ("Immersion and depth are solved together, since t_a depends on the immersion; the depth comes from F_at as "
         "well, "
         "because F_ax crosses zero near R_r = 1.4. In up milling below R_r = 0.3 the ratio tells nothing, and the "
         "estimator "
         "says so."),
    };
}

}  // namespace
}  // namespace kim_reproduction

Reproduction reproduce_kim() {
    using namespace kim_reproduction;
    Reproduction result;
    result.name = "kim";
    result.title = "Rapid calibration from motor currents: friction, gains, cutting coefficients (Kim & Chung)";
    add_table_1(result);
    add_average_forces(result);
    add_force_ratio(result);
    add_check_values(result);
    add_drive_equations(result);
    std::vector<KimCampaign> campaigns;
    for (std::uint64_t number = 1; number <= machines; ++number) {
        campaigns.push_back(calibrate_machine(KimMachine::numbered(number), tools()[0].law));
    }
    add_gains(campaigns, result);
    std::array<std::vector<KimUnknownTool>, 2> found;
    for (std::size_t k = 0; k < found.size(); ++k) {
        for (const KimCampaign& campaign : campaigns) {
            found[k].push_back(calibrate_tool(campaign, tools()[k].law, 3 + k));
        }
        add_coefficients(tools()[k], found[k], result);
    }
    add_engagement(campaigns, found[1], tools()[1].law, result);
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto& tool = tools()[k];
        add_coefficient_plot({fmt::format("{} end mill", tool.name), k == 0 ? "Fig. 3" : "Fig. 7", tool.law},
                             found[k].front(), result);
    }
    add_drive_plots(campaigns.front(), result);
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto& tool = tools()[k];
        add_comparison_plot({tool.name, k == 0 ? "Fig. 8a" : "Fig. 8b", tool.law},
                            {tool.k_s_by_currents, tool.p_s_by_currents}, found[k].front(), result);
    }
    result.deviations = deviations();
    return result;
}

}  // namespace millforce::sim
