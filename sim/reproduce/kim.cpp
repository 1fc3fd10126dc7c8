// SPDX-License-Identifier: Apache-2.0
#include "reproduce/kim_campaign.hpp"
#include "reproduce/kim_checks.hpp"
#include "reproduce/kim_plots.hpp"
#include "reproduce/kim_published.hpp"
#include "reproduce/reproduction.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

/// Kim & Chung: what the paper prints, and its three steps on simulated machines.

namespace millforce::sim {
namespace kim_reproduction {
namespace {

using Judged = Figure::Judged;

constexpr std::uint64_t machines = 12;

void add_table_1(Reproduction& result) {
    auto& figures = result.figures;
    figures.push_back({"Table 1: cutting speed", "m/min", 31.6673,
                       std::numbers::pi * KimStandardCut::diameter_mm * KimStandardCut::spindle_rpm / 1000.0,
                       Judged::difference, 1e-4});
    figures.push_back(
        {"Table 1: feed per tooth", "mm", 0.0496, KimStandardCut::feed_per_tooth_mm, Judged::difference, 5e-5});
    figures.push_back(
        {"Table 1: volume removed per tooth", "mm³", 0.4762,
         KimStandardCut::feed_per_tooth_mm * KimStandardCut::radial_width_mm * KimStandardCut::axial_depth_mm,
         Judged::difference, 5e-5});
}

void add_largest_force(Reproduction& result) {
    constexpr double widest_mm = 2.0;
    constexpr double fastest_mm_min = 700.0;
    const double f_z = fastest_mm_min / (KimStandardCut::flutes * KimStandardCut::spindle_rpm);
    const auto largest = kim_forces_by_integration(kim_tools[0].law, widest_mm / KimStandardCut::radius_mm, f_z);
    result.figures.push_back(
        {"Section 3.1: largest average force of its feeds (to 700 mm/min) and widths (to 2 mm), designed not to exceed "
         "this",
         "N", 1000.0, largest.tangential_N, Judged::shown, 0.0, 0.0,
         "the force follows from the paper's own coefficients (Table 2): its largest feed and width together are a "
         "little beyond its design."});
}

constexpr const char* pressure_unit = "N/mm²";

/// The constants of the paper's drives beside those of the first simulated machine.
void add_drive_constants(const KimCampaign& campaign, Reproduction& result) {
    using Published = KimPublishedDrives;
    constexpr double per_Nm = 1000.0 / KimStandardCut::radius_mm;
    const auto& spindle = campaign.gains.spindle;
    const auto& axis = campaign.calibrated.axes[0];
    const auto& feed = *campaign.gains.axes[0];
    const auto show = [&](const char* name, const char* unit, double published, double ours, const char* reason) {
        result.figures.push_back({name, unit, published, ours, Judged::shown, 0.0, 0.0, reason});
    };
    show(
        "Eq. 8: K_t1", "N per A", Published::K_t1, spindle.gain * per_Nm,
        "a constant of each machine, in N per unit of current: ours is the ampere, the paper's is not printed. Ours is "
        "judged against the simulated motor's, below.");
    show("Eq. 8: K_t2", "N", Published::K_t2_N, spindle.offset * per_Nm,
         "the idle torque of each spindle, at the radius of 4 mm. Ours is judged below.");
    show("Table 3: K_x1", "A·min²/m²", Published::K_x1, static_cast<double>(axis.positive.K_x1_A_min2_per_m2),
         "friction of each axis, its current in ampere here; the paper's unit is not printed. There the current "
         "falls with the feed.");
    show("Table 3: K_x2", "A·min/m", Published::K_x2, static_cast<double>(axis.positive.K_x2_A_min_per_m), "as K_x1.");
    show("Table 3: K_x3", "A", Published::K_x3, static_cast<double>(axis.K_x3_A), "as K_x1.");
    const char* copied =
        "Table 3 repeats K_t1 and K_t2 of Eq. 8 to the digit. With them the feed force is −7644 N at 0.25 m/min where "
        "the axis only overcomes its friction: they cannot be the feed drive's.";
    show("Table 3: K_x4", "N per A", Published::K_x4, feed.gain, copied);
    show("Table 3: K_x5", "N·m/min", Published::K_x5, feed.offset,
         "as K_x4. In the plant it has no counterpart: ours is what the quadratic friction leaves at low feed.");
}

/// Deviations of the coefficients by currents from those by forces, over all machines.
struct KimTallies {
    KimTally k_s;
    KimTally p_s;
    KimTally k_1;
    KimTally p_1;

    KimTallies(const KimPublishedTool& tool, const std::vector<KimUnknownTool>& found) {
        for (const KimUnknownTool& t : found) {
            const auto& fit = t.fit;
            k_s.add(fit.law.k_s_N_per_mm2 - tool.law.k_s, fit.k_s_standard_error(), tool.law.k_s);
            p_s.add(fit.law.p_s - tool.law.p_s, fit.standard_error(estimation::cutting_p_s), tool.law.p_s);
            k_1.add(fit.law.k_1 - tool.law.k_1, fit.k_1_standard_error(), tool.law.k_1);
            p_1.add(fit.law.p_1 - tool.law.p_1, fit.standard_error(estimation::cutting_p_1), tool.law.p_1);
        }
    }
};

void add_law_against_forces(const KimPublishedTool& tool, const KimUnknownTool& found, Reproduction& result) {
    const auto& fit = found.fit;
    const auto add = [&](const char* what, const char* unit, double published, double ours, double se, double bound) {
        result.figures.push_back({fmt::format("{}, {}: {} by forces; ours from currents alone (standard error {:.2g})",
                                              tool.table, tool.name, what, se),
                                  unit, published, ours, Judged::relative_difference, bound});
    };
    add("k_s", pressure_unit, tool.law.k_s, fit.law.k_s_N_per_mm2, fit.k_s_standard_error(), 0.045);
    add("p_s", "", tool.law.p_s, fit.law.p_s, fit.standard_error(estimation::cutting_p_s), 0.06);
    add("k_1", "", tool.law.k_1, fit.law.k_1, fit.k_1_standard_error(), 0.045);
    add("p_1", "", tool.law.p_1, fit.law.p_1, fit.standard_error(estimation::cutting_p_1), 0.06);
}

void add_law_by_currents(const KimPublishedTool& tool, const KimUnknownTool& found, const KimTallies& tallies,
                         Reproduction& result) {
    const auto deviation_percent = [](double by_currents, double by_forces) {
        return 100.0 * std::abs(by_currents / by_forces - 1.0);
    };
    const double k_s_percent = deviation_percent(tool.k_s_by_currents, tool.law.k_s);
    const double p_s_percent = deviation_percent(tool.p_s_by_currents, tool.law.p_s);
    const auto by_currents = [&](const char* what, const char* unit, double published, double ours, double percent) {
        result.figures.push_back(
            {fmt::format("Table 5, {}: {} by motor currents", tool.name, what), unit, published, ours, Judged::shown,
             0.0, 0.0,
             fmt::format("the paper's lies {:.1f} % from its own by forces ({}). Ours is judged against "
                         "the one by forces, above.",
                         percent, tool.table)});
    };
    by_currents("k_s", pressure_unit, tool.k_s_by_currents, found.fit.law.k_s_N_per_mm2, k_s_percent);
    by_currents("p_s", "", tool.p_s_by_currents, found.fit.law.p_s, p_s_percent);
    const auto worst = [&](const char* what, const KimTally& tally, double percent, double bound) {
        result.figures.push_back(
            {fmt::format("Table 5 against {}, {}: deviation of {}; ours: the largest of {} machines", tool.table,
                         tool.name, what, machines),
             "%", percent, 100.0 * tally.largest, Judged::at_most, bound});
    };
    worst("k_s", tallies.k_s, k_s_percent, 4.5);
    worst("p_s", tallies.p_s, p_s_percent, 6.0);
}

void add_law_checks(const KimPublishedTool& tool, const KimTallies& tallies, Reproduction& result) {
    const auto not_printed = [&](const char* what, const KimTally& tally, double bound) {
        result.checks.push_back(own_check(
            fmt::format("Step 3, {}: largest deviation of {} by currents over {} machines", tool.name, what, machines),
            "%", 100.0 * tally.largest, Judged::at_most, bound));
    };
    not_printed("k_1", tallies.k_1, 4.5);
    not_printed("p_1", tallies.p_1, 6.0);
    const double within = tallies.k_s.within + tallies.p_s.within + tallies.k_1.within + tallies.p_1.within;
    result.checks.push_back(
        own_check(fmt::format("Step 3, {}: coefficients within two standard errors, {} machines (Student's t, 8 "
                              "degrees of freedom: 92 %)",
                              tool.name, machines),
                  "%", 100.0 * within / (4.0 * static_cast<double>(machines)), Judged::within, 100.0, 85.0));
}

void add_coefficients(const KimPublishedTool& tool, const std::vector<KimUnknownTool>& found, Reproduction& result) {
    const KimTallies tallies(tool, found);
    add_law_against_forces(tool, found.front(), result);
    add_law_by_currents(tool, found.front(), tallies, result);
    add_law_checks(tool, tallies, result);
}

std::vector<std::string> deviations() {
    return {
        ("Eq. 4 prints R_r before the brackets of F_ax and F_ay; integration of the edge elements gives R_a. In B_r "
         "the printed φ_N is the entry angle φ_r."),
        ("Table 3 prints K_x4 = 196.61 and K_x5 = −1911.00: K_t1 and K_t2 of Eq. 8 to the digit. With them F_ax is "
         "−7644 N at 0.25 m/min where the axis only overcomes its friction. Here both are calibrated, by standard "
         "cuts."),
        ("Section 3.3 refers to Tables 3 and 4 for the coefficients; they stand in Tables 2 and 4. Fig. 5 and Fig. 6 "
         "give no unit of current; here: ampere."),
        ("The paper's forces for the comparison come from a dynamometer. Here the plant's cutting force has the "
         "published law, and between it and the coefficients stand the simulated drives: inertia, friction with "
         "pre-sliding and Stribeck's fall at low feed, ripple over the screw's pitch, noise of 1 % of the rated "
         "current, quantisation to a per mille, and a bearing that warms up."),
        ("The helix is not printed: 30°. At 12 mm depth its lag is a tooth pitch, and the force hardly ripples."),
        ("Each cut has running in air at its own feed before it: idle current and friction are taken from there, not "
         "from Eqs. 8 and 9 of another day. So r_1 comes out as well, where the paper finds large errors."),
        ("The plant's chip is the paper's, f_z sin φ. With the trochoidal chip over the same engagement angles the "
         "force of a cut 0.2 mm wide at 0.14 mm per tooth is 9 % higher, because such a cut removes more than f_z "
         "a_e."),
        ("Immersion and depth are solved together, since t_a depends on the immersion; the depth comes from F_at as "
         "well, because F_ax crosses zero near R_r = 1.4. In up milling below R_r = 0.3 the ratio shows nothing, and "
         "the estimator says so."),
    };
}

std::vector<NotReproduced> not_reproduced() {
    return {
        {"Figs. 3 and 5–8: measured points",
         "the text that this project has holds no images, and the paper prints no table of them. Drawn instead: the "
         "printed fits of Tables 2 to 5, and our points on the simulated machine."},
        {"Fig. 6: the paper's line",
         "its K_x4 and K_x5 are printed as the spindle's (see Table 3 above). Ours is drawn alone."},
        {"Section 3.3: r_1 by motor currents", "the paper speaks of large errors and prints no value."},
        {"Figs. 1 and 2", "sketches of the cut: they show no data."},
    };
}

constexpr const char* summary =
    "The motors of a milling machine show the cutting force, once it is known how much force a current means. Three "
    "steps find that out without a dynamometer: running in air gives the friction, standard cuts with a known tool "
    "give the motors' constants, and cuts with an unknown tool then give its cutting coefficients. Here the steps "
    "run on twelve simulated machines, whose currents have friction, noise and drift, and what they find is held "
    "against the published coefficients that the simulated material has.";

}  // namespace
}  // namespace kim_reproduction

Reproduction reproduce_kim() {
    using namespace kim_reproduction;
    Reproduction result;
    result.name = "kim";
    result.title = "Rapid calibration from motor currents: friction, gains, cutting coefficients (Kim & Chung)";
    result.source = {
        "S.-C. Kim, S.-C. Chung: Rapid Calibration of Cutting Force Control System Using Motor Currents in End Milling "
        "Processes. Hanyang University, Department of Mechanical Design & Production Engineering, Seoul. Venue and "
        "year "
        "are not printed on the copy used; its newest reference is of 1999."};
    result.summary = summary;
    add_table_1(result);
    add_largest_force(result);
    check_kim_equations(result);
    std::vector<KimCampaign> campaigns;
    for (std::uint64_t number = 1; number <= machines; ++number) {
        campaigns.push_back(calibrate_machine(KimMachine::numbered(number), kim_tools[0].law));
    }
    add_drive_constants(campaigns.front(), result);
    check_kim_gains(campaigns, result);
    std::array<std::vector<KimUnknownTool>, 2> found;
    for (std::size_t k = 0; k < found.size(); ++k) {
        for (const KimCampaign& campaign : campaigns) {
            found[k].push_back(calibrate_tool(campaign, kim_tools[k].law, 3 + k));
        }
        add_coefficients(kim_tools[k], found[k], result);
    }
    check_kim_engagement(campaigns, found[1], kim_tools[1].law, result);
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto& tool = kim_tools[k];
        add_coefficient_plot({fmt::format("{} end mill", tool.name), k == 0 ? "Fig. 3" : "Fig. 7", tool.law},
                             found[k].front(), result);
    }
    add_drive_plots(campaigns.front(), result);
    for (std::size_t k = 0; k < found.size(); ++k) {
        const auto& tool = kim_tools[k];
        add_comparison_plot({tool.name, k == 0 ? "Fig. 8a" : "Fig. 8b", tool.law},
                            {tool.k_s_by_currents, tool.p_s_by_currents}, found[k].front(), result);
    }
    result.deviations = deviations();
    result.not_reproduced = not_reproduced();
    return result;
}

}  // namespace millforce::sim
