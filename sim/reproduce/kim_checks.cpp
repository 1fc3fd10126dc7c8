// SPDX-License-Identifier: Apache-2.0
#include "reproduce/kim_checks.hpp"

#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation_calibration/engagement_solver_in_double.hpp"
#include "firmware/parameters.hpp"
#include "reproduce/kim_published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace millforce::sim {
namespace {

using Judged = Figure::Judged;
using estimation::CutSide;

constexpr const AverageChipLaw& carbide = kim_tools[0].law;

estimation::CutConditions<double> conditions(double radial_immersion, CutSide side, double feed_per_tooth_mm) {
    return {feed_per_tooth_mm, KimStandardCut::axial_depth_mm, estimation::engagement_angles(side, radial_immersion),
            static_cast<double>(KimStandardCut::flutes)};
}

/// Eq. 4 in the paper's symbols, with R_a where it prints R_r, φ_r where it prints φ_N.
estimation::AverageForces<double> by_equation_4(const AverageChipLaw& law, double R_r, double t_c) {
    constexpr double tan_beta = 0.5;  // cancels
    const double R = KimStandardCut::radius_mm;
    const double R_a = KimStandardCut::axial_depth_mm / R;
    const double phi_N = turn / KimStandardCut::flutes;
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
    return {load.mean_torque_Nm * 1000.0 / KimStandardCut::radius_mm, load.mean_fx_N, load.mean_fy_N};
}

void check_average_forces(Reproduction& out) {
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
            const auto closed = estimation::average_forces(closed_law(carbide), down);
            of_equation_4 = std::max(of_equation_4, apart(by_equation_4(carbide, R_r, f_z), closed));
            of_integration = std::max(of_integration, apart(by_integration(carbide, down), closed));
            up_of_integration = std::max(up_of_integration, apart(by_integration(carbide, up),
                                                                  estimation::average_forces(closed_law(carbide), up)));
        }
    }
    out.checks.push_back(
        own_check("Eq. 4 with R_a and φ_r in their places, against the closed averages for any engagement: largest "
                  "deviation over F_at, 30 cuts, down milling",
                  "", of_equation_4, Judged::at_most, 1e-9));
    out.checks.push_back(
        own_check("Eq. 4 against the plant's integration of edge elements: largest deviation, 30 cuts, down milling",
                  "%", 100.0 * of_integration, Judged::at_most, 0.02));
    out.checks.push_back(own_check("The same averages in up milling, which the paper leaves out", "%",
                                   100.0 * up_of_integration, Judged::at_most, 0.02));
    const auto cut = conditions(0.2, CutSide::down, KimStandardCut::feed_per_tooth_mm);
    const auto standard = by_integration(carbide, cut);
    const auto closed = estimation::average_forces(closed_law(carbide), cut);
    const double largest_N =
        std::max({std::abs(standard.tangential_N - closed.tangential_N), std::abs(standard.feed_N - closed.feed_N),
                  std::abs(standard.normal_N - closed.normal_N)});
    out.checks.push_back(
        own_check("Standard cut (Table 1): largest deviation of the integrated F_at, F_ax and F_ay "
                  "from the closed averages",
                  "N", largest_N, Judged::at_most, 0.1));
}

/// Eq. 6: where the ratio determines the immersion, and where it does not.
void check_force_ratio(Reproduction& out) {
    const auto ratio = [&](CutSide side, double R_r) {
        const auto forces = by_integration(carbide, conditions(R_r, side, KimStandardCut::feed_per_tooth_mm));
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
    out.checks.push_back(own_check("Eq. 6: F_ax/F_at grows with the immersion throughout in down milling (1: yes)", "",
                                   monotone ? 1.0 : 0.0, Judged::at_least, 1.0));
    out.checks.push_back(
        own_check("Eq. 6: change of F_ax/F_at from R_r 0.05 to 0.2 in up milling, as a share of that in down "
                  "milling: it hardly depends on the immersion there",
                  "", change(CutSide::up) / change(CutSide::down), Judged::at_most, 0.1));
}

/// Values calculated outside the program, by disc integration of Eqs. 2 and 3 at f_z 0.0496 mm.
void check_outside_values(Reproduction& out) {
    struct Forces {
        double R_r, F_at, F_ax, F_ay;
    };
    constexpr double f_z = 0.0496;
    double largest_N = 0.0;
    for (const Forces& check :
         {Forces{0.2, 221.92, -160.96, -176.06}, {1.0, 923.72, -184.36, -902.15}, {2.0, 1847.44, 555.00, -1450.98}}) {
        const auto forces = estimation::average_forces(closed_law(carbide), conditions(check.R_r, CutSide::down, f_z));
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
        const auto forces = estimation::average_forces(closed_law(carbide), conditions(check.R_r, check.side, f_z));
        largest_ratio = std::max(largest_ratio, std::abs(forces.feed_N / forces.tangential_N - check.F_ax_over_F_at));
    }
    out.checks.push_back(own_check("Eq. 4: largest deviation of nine forces (a_e 0.8, 4, 8 mm) from disc integration",
                                   "N", largest_N, Judged::at_most, 0.02));
    out.checks.push_back(
        own_check("Eq. 6: largest deviation of eleven force ratios, down and up, from disc integration", "",
                  largest_ratio, Judged::at_most, 0.001));
}

/// The drives' classes with the paper's constants in them, against Eqs. 8–10 by hand.
void check_drive_equations(Reproduction& out) {
    using Published = KimPublishedDrives;
    estimation::SpindleDriveParameters<double> spindle;
    spindle.K_t1_Nm_per_A = Published::K_t1 * KimStandardCut::radius_mm / 1000.0;
    spindle.K_t2_Nm = Published::K_t2_N * KimStandardCut::radius_mm / 1000.0;
    const estimation::SpindleDrive<double> spindle_drive(spindle);
    constexpr double current = 12.0;
    const double F_at = spindle_drive
                            .tangential_force_N({.current_A = current, .speed_rad_s = 131.9, .present = true},
                                                KimStandardCut::radius_mm)
                            .value;
    estimation::FeedDriveParameters<double> feed;
    feed.positive = {Published::K_x1, Published::K_x2};
    feed.K_x3_A = Published::K_x3;
    feed.K_x4_N_per_A = Published::K_x4;
    feed.K_x5_N_m_per_min = Published::K_x5;
    const estimation::FeedDrive<double> feed_drive(feed);
    constexpr double w = 0.25;
    const double F_ax = feed_drive.force_N({Published::friction_current(w), w / 0.06, 0.0, 1.0, 1.0, true}).value;
    out.checks.push_back(
        own_check("Eq. 8 with its constants: deviation of the spindle drive's F_at at 12 units of current", "N",
                  std::abs(F_at - (Published::K_t1 * current + Published::K_t2_N)), Judged::at_most, 1e-6));
    out.checks.push_back(own_check("Eqs. 9 and 10 with Table 3: deviation of the feed drive's F_ax at 0.25 m/min", "N",
                                   std::abs(F_ax - Published::K_x5 / w), Judged::at_most, 1e-6));
    out.checks.push_back(
        own_check("Eqs. 9 and 10 with Table 3: F_ax at 0.25 m/min where the current is friction's "
                  "alone, which should be 0",
                  "N", F_ax));
}

}  // namespace

estimation::AverageForces<double> kim_forces_by_integration(const AverageChipLaw& law, double radial_immersion,
                                                            double feed_per_tooth_mm) {
    return by_integration(law, conditions(radial_immersion, CutSide::down, feed_per_tooth_mm));
}

void KimTally::add(double error, double standard_error, double truth) {
    largest = std::max(largest, std::abs(error / truth));
    within += std::abs(error) <= 2.0 * standard_error ? 1 : 0;
}

void check_kim_equations(Reproduction& out) {
    check_average_forces(out);
    check_force_ratio(out);
    check_outside_values(out);
    check_drive_equations(out);
}

void check_kim_gains(const std::vector<KimCampaign>& campaigns, Reproduction& out) {
    KimTally spindle;
    KimTally feed;
    KimTally idle;
    for (const KimCampaign& c : campaigns) {
        const auto& x = *c.gains.axes[0];
        spindle.add(c.gains.spindle.gain - c.machine.torque_constant_Nm_per_A, c.gains.spindle.gain_se,
                    c.machine.torque_constant_Nm_per_A);
        idle.add(c.gains.spindle.offset + c.idle_torque_Nm, c.gains.spindle.offset_se, c.idle_torque_Nm);
        feed.add(x.gain - c.machine.force_constant_N_per_A, x.gain_se, c.machine.force_constant_N_per_A);
    }
    const auto machines = static_cast<double>(campaigns.size());
    const auto add = [&](const std::string& what, const KimTally& tally, double bound) {
        out.checks.push_back(own_check(
            fmt::format("Step 2: {} by standard cuts, largest error over {} machines", what, campaigns.size()), "%",
            100.0 * tally.largest, Judged::at_most, bound));
    };
    add("K_t1", spindle, 1.0);
    add("K_t2, the warm idle torque,", idle, 3.0);
    add("K_x4", feed, 1.5);
    const double within = spindle.within + idle.within + feed.within;
    out.checks.push_back(
        own_check("Step 2: K_t1, K_t2 and K_x4 within two standard errors (Student's t, 10 degrees of freedom: 93 %)",
                  "%", 100.0 * within / (3.0 * machines), Judged::within, 100.0, 85.0));
}

namespace {

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
    const double F_at = row.spindle_torque_Nm * 1000.0 / KimStandardCut::radius_mm;
    const auto square = [](double value) { return value * value; };
    estimation::AverageForceMeasurement<double> m;
    m.tangential_N = {true, F_at,
                      square(torque_sd * 1000.0 / KimStandardCut::radius_mm) +
                          square(campaign.gain_doubt.tangential_relative_sd * F_at),
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
    settings.law_relative_sd = firmware::ToolParameters<double>{}.law_relative_sd;
    const estimation::EngagementSolver<double> solver(tool.fit.law, settings);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto found = solver.solve(measured_forces(rows[k], stretches[2 * k + 1], campaign),
                                        rows[k].feed_per_tooth_mm(), CutSide::down);
        const double R_r = rows[k].radial_width_mm / KimStandardCut::radius_mm;
        const double depth = rows[k].axial_depth_mm;
        tally.immersion_squares += std::pow(found.radial_immersion - R_r, 2.0);
        tally.depth_squares += std::pow(found.axial_depth_mm / depth - 1.0, 2.0);
        tally.immersion_within += found.radial_immersion_low <= R_r && R_r <= found.radial_immersion_high ? 1 : 0;
        tally.depth_within += std::abs(found.axial_depth_mm - depth) <= 1.96 * found.axial_depth_sd_mm ? 1 : 0;
        ++tally.count;
    }
}

}  // namespace

void check_kim_engagement(const std::vector<KimCampaign>& campaigns, const std::vector<KimUnknownTool>& tools_found,
                          const AverageChipLaw& law, Reproduction& out) {
    constexpr std::size_t few = 5;
    EngagementTally tally;
    for (std::size_t k = 0; k < few; ++k) {
        tally_engagements(campaigns[k], tools_found[k], law, tally);
    }
    const double count = tally.count;
    out.checks.push_back(
        own_check(fmt::format("Eq. 6: radial immersion of {} new cuts (0.15 to 2), error rms", tally.count), "",
                  std::sqrt(tally.immersion_squares / count), Judged::at_most, 0.05));
    out.checks.push_back(own_check("Eq. 7: their axial depth, relative error rms", "%",
                                   100.0 * std::sqrt(tally.depth_squares / count), Judged::at_most, 5.0));
    out.checks.push_back(own_check("Eqs. 6 and 7: 95 % intervals that hold the truth", "%",
                                   100.0 * (tally.immersion_within + tally.depth_within) / (2.0 * count),
                                   Judged::at_least, 90.0));
}

}  // namespace millforce::sim
