// SPDX-License-Identifier: Apache-2.0
#include "reproduce/kim_plots.hpp"

#include "reproduce/kim_published.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace millforce::sim {

namespace {

using PlotSeries = Plot::Series;

constexpr double thinnest_mm = 0.005;
constexpr double thickest_mm = 0.07;

PlotSeries curve(const std::string& name, double low, double high, const std::function<double(double)>& of) {
    PlotSeries series{name, PlotSeries::Style::line, {}, {}};
    for (int k = 0; k <= 60; ++k) {
        const double x = low + (high - low) * k / 60.0;
        series.x.push_back(x);
        series.y.push_back(of(x));
    }
    return series;
}

std::function<double(double)> power(double k, double p) {
    return [k, p](double t) { return k * std::pow(t, p); };
}

/// K_s and r_1 of one cut alone, from its two forces.
struct CutCoefficients {
    double chip_mm;
    double K_s;
    double r_1;
};

CutCoefficients of_cut(const host::CutRow& row) {
    const auto m = row.measurement(estimation::CutSide::down);
    const auto i = estimation::engagement_integrals(m.cut.engagement);
    const double per_pressure =
        m.cut.feed_per_tooth_mm * m.cut.axial_depth_mm * m.cut.teeth / (2.0 * estimation::pi<double>);
    const double K_s = m.tangential_N / (per_pressure * i.c);
    return {m.cut.feed_per_tooth_mm * i.mean_sine, K_s, (m.feed_N / (per_pressure * K_s) - i.s) / i.b};
}

PlotSeries points_of(const std::string& name, const KimUnknownTool& tool, double CutCoefficients::*value) {
    PlotSeries series{name, PlotSeries::Style::points, {}, {}};
    for (const host::CutRow& row : tool.cuts) {
        const CutCoefficients cut = of_cut(row);
        series.x.push_back(cut.chip_mm);
        series.y.push_back(cut.*value);
    }
    return series;
}

}  // namespace

void add_coefficient_plot(const KimDrawn& drawn, const KimUnknownTool& tool, Reproduction& result) {
    result.plots.push_back(
        {fmt::format("Cutting pressure over the mean chip thickness, {} ({})", drawn.name, drawn.figure),
         "mean chip thickness in mm",
         "K_s in N/mm²",
         "Line: the published law, by forces. Points: single cuts on the simulated machine, from the "
         "spindle's current alone.",
         {curve("published", thinnest_mm, thickest_mm, power(drawn.law.k_s, drawn.law.p_s)),
          points_of("from currents", tool, &CutCoefficients::K_s)}});
    result.plots.push_back(
        {fmt::format("Force ratio r_1 over the mean chip thickness, {} ({})", drawn.name, drawn.figure),
         "mean chip thickness in mm",
         "r_1",
         "The same for r_1, from both drives' currents. F_ax is the difference of two larger terms: the "
         "points scatter more than those of K_s.",
         {curve("published", thinnest_mm, thickest_mm, power(drawn.law.k_1, drawn.law.p_1)),
          points_of("from currents", tool, &CutCoefficients::r_1)}});
}

namespace {

void add_friction_plots(const KimCampaign& campaign, Reproduction& result) {
    const auto friction = [&](double w) {
        return host::signed_friction_current_A(campaign.calibrated, 0, w) +
               static_cast<double>(campaign.calibrated.axes[0].gravity_A);
    };
    PlotSeries air{"air cuts", PlotSeries::Style::points, {}, {}};
    for (const KimAirCut& cut : campaign.air_cuts) {
        if (cut.feed_m_per_min > 0.0) {
            air.x.push_back(cut.feed_m_per_min);
            air.y.push_back(cut.current_A);
        }
    }
    result.plots.push_back(
        {"Feed drive's current in air over the feed (Fig. 5)",
         "feed in m/min",
         "current in A",
         "Points: steady feeds in air. Line: the quadratic of Eq. 9. At the lowest feeds friction rises "
         "again (Stribeck), which no quadratic follows.",
         {air, curve("K_x1 w² + K_x2 w + K_x3", 0.1, 1.0, friction)}});
    constexpr double reference_m_min = 0.25;
    result.plots.push_back(
        {"The same as a share of the current at 0.25 m/min, with the paper's fit (Fig. 5, Table 3)",
         "feed in m/min",
         "share of the current at 0.25 m/min",
         "The paper prints K_x1, K_x2 and K_x3 without a unit of current: only shares can be compared. Its feeds go "
         "from 0.1 to 0.7 m/min.",
         {curve("published", 0.1, 0.7,
                [&](double w) {
                    return KimPublishedDrives::friction_current(w) /
                           KimPublishedDrives::friction_current(reference_m_min);
                }),
          curve("simulated machine", 0.1, 0.7, [&](double w) { return friction(w) / friction(reference_m_min); })}});
}

void add_gain_plots(const KimCampaign& campaign, Reproduction& result) {
    const auto law = closed_law(kim_tools[0].law);
    PlotSeries feed{"standard cuts and air", PlotSeries::Style::points, {}, {}};
    PlotSeries spindle{"standard cuts and air", PlotSeries::Style::points, {}, {}};
    const double kappa = campaign.gains.axes[0]->nuisance;
    for (const host::RecordedStretch& s : campaign.standard_cuts) {
        const auto side = estimation::CutSide::down;
        const auto forces = estimation::average_forces<double>(
            law,
            {s.feed_per_tooth_mm(), s.conditions.axial_depth_mm,
             estimation::engagement_angles(side, 2.0 * s.conditions.radial_width_mm / s.conditions.tool_diameter_mm),
             static_cast<double>(s.conditions.flutes)});
        feed.x.push_back(s.axis_current_A - static_cast<double>(campaign.calibrated.axes[0].gravity_A) -
                         kappa * host::signed_friction_current_A(campaign.calibrated, 0, s.feed_m_per_min()));
        feed.y.push_back(s.conditions.in_cut() ? forces.feed_N : 0.0);
        spindle.x.push_back(s.spindle_current_A);
        spindle.y.push_back(s.conditions.in_cut() ? forces.tangential_N : 0.0);
    }
    const auto& x_gain = *campaign.gains.axes[0];
    result.plots.push_back({"Feed force over the current without friction (Fig. 6)",
                            "I − I_f in A",
                            "F_ax in N",
                            "Forces by the database. The slope is K_x4; K_x5/w moves single points by a few newtons.",
                            {feed, curve("K_x4 (I − I_f)", -4.0, 0.0, [&](double I) { return x_gain.gain * I; })}});
    const double per_Nm = 1000.0 / (0.5 * KimStandardCut::diameter_mm);
    const auto& s = campaign.gains.spindle;
    result.plots.push_back(
        {"Tangential force over the spindle's current (Fig. 4, Eq. 8)",
         "current in A",
         "F_at in N",
         "Line: K_t1 I + K_t2 of the warm spindle. The bearing is still warming up: the first points lie "
         "to the right of it.",
         {spindle, curve("K_t1 I + K_t2", -s.offset / s.gain, 4.0,
                         [&](double I) { return (s.gain * I + s.offset) * per_Nm; })}});
    result.plots.push_back(
        {"The same over the idle current, with the paper's line (Eq. 8)",
         "current as a multiple of the idle current",
         "F_at in N",
         "The paper prints no unit of current: it is counted in idle currents, −K_t2/K_t1. Then the slope is −K_t2, "
         "what the idle spindle takes at the tool's radius of 4 mm.",
         {curve("published", 1.0, 1.5,
                [](double idle_currents) { return -KimPublishedDrives::K_t2_N * (idle_currents - 1.0); }),
          curve("simulated machine", 1.0, 4.0,
                [&](double idle_currents) { return -s.offset * per_Nm * (idle_currents - 1.0); })}});
}

}  // namespace

void add_drive_plots(const KimCampaign& campaign, Reproduction& result) {
    add_friction_plots(campaign, result);
    add_gain_plots(campaign, result);
}

void add_comparison_plot(const KimDrawn& drawn, const KimPressureLaw& by_published_currents, const KimUnknownTool& tool,
                         Reproduction& result) {
    const auto& fitted = tool.fit.law;
    result.plots.push_back(
        {fmt::format("Cutting pressure by forces and by currents, {} ({})", drawn.name, drawn.figure),
         "mean chip thickness in mm",
         "K_s in N/mm²",
         "The published law by forces, the published law by motor currents (Table 5), and the one fitted here from "
         "simulated currents.",
         {curve("by forces, published", thinnest_mm, thickest_mm, power(drawn.law.k_s, drawn.law.p_s)),
          curve("by currents, published", thinnest_mm, thickest_mm,
                power(by_published_currents.k_s, by_published_currents.p_s)),
          curve("by currents, here", thinnest_mm, thickest_mm, power(fitted.k_s_N_per_mm2, fitted.p_s))}});
}

}  // namespace millforce::sim
