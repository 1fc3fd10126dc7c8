// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "reproduce/reproduction.hpp"
#include "reproduce/yang_plots.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_random_cuts.hpp"
#include "reproduce/yang_tables.hpp"

/// Depth-of-cut variation from the force's shape (Yang, DeVor & Kapoor): the published tests, by the published method
/// and by the fit of the whole profile, and a thousand cuts drawn at random.

namespace millforce::sim {
namespace yang {

using Judged = Figure::Judged;
constexpr double not_published = std::numeric_limits<double>::quiet_NaN();

/// Mean absolute error of a method over some tests, in percent of nominal, and how many of the estimates there are.
struct MeanError {
    double sum_percent = 0.0;
    int count = 0;
    int missing = 0;

    void add(const Series& series, Method method) {
        for (const Test& test : series.tests) {
            add(test.estimate[method].axial - test.truth.axial);
            add(test.estimate[method].radial - test.truth.radial);
        }
    }
    [[nodiscard]] double percent() const { return sum_percent / count; }
    [[nodiscard]] double answered_share() const { return static_cast<double>(count) / (count + missing); }

  private:
    void add(double error_percent) {
        if (std::isnan(error_percent)) {
            ++missing;
            return;
        }
        sum_percent += std::abs(error_percent);
        ++count;
    }
};

MeanError mean_error(const std::vector<Series>& all, Method method, std::initializer_list<std::size_t> types) {
    MeanError error;
    for (const Series& series : all) {
        for (const std::size_t type : types) {
            if (series.type == type) {
                error.add(series, method);
            }
        }
    }
    return error;
}

std::string table_name(std::size_t type) {
    return fmt::format("Table {} (type {})", type + 5, std::array{"I", "II", "III"}[type]);
}

/// Every published number and the profile fit's: absolute error, percent of nominal.
void add_rows(const std::vector<Series>& all, Reproduction& r) {
    constexpr double row_bound_percent = 4.0;
    for (const Series& series : all) {
        for (std::size_t t = 0; t < series.tests.size(); ++t) {
            const Test& test = series.tests[t];
            const auto add = [&](const char* depth, double truth, double printed, double fitted) {
                r.figures.push_back({.name = fmt::format("{}, mill {}, test {}: error of {} = {:+.0f} %, profile fit",
                                                         table_name(series.type), series.mill + 1, t + 1, depth, truth),
                                     .unit = "%",
                                     .published = std::abs(printed - truth),
                                     .ours = std::abs(fitted - truth),
                                     .judged = Judged::at_most,
                                     .bound = row_bound_percent});
            };
            add("δADOC", test.truth.axial, test.estimate[as_published].axial, test.estimate[profile_fit].axial);
            add("δRDOC", test.truth.radial, test.estimate[as_published].radial, test.estimate[profile_fit].radial);
        }
    }
}

struct MethodLine {
    Method method;
    const char* name;
    std::array<double, 3> bound_percent;  ///< by type; 0: shown
};

/// Mean absolute error per table and method. Type III is judged where Table 1's row for it can hold.
void add_means(const std::vector<Series>& all, Reproduction& r) {
    constexpr std::array<MethodLine, 6> lines = {{
        {against_nominal, "Table 1 on the resultant, angles against the nominal cut", {3.0, 3.0, 0.0}},
        {printed_on_vectors, "Table 1 on the resultant, angles as read", {0.0, 3.0, 0.0}},
        {printed_on_scalars, "Table 1 on flute forces added as scalars", {3.0, 3.0, 0.0}},
        {corrected_on_scalars, "III/LO, III/MO by α_sw, on flute forces added as scalars", {3.0, 3.0, 3.0}},
        {profile_fit, "profile fit", {1.0, 1.0, 1.0}},
        {profile_fit_alone, "profile fit, tip's angle unknown", {0.0, 0.0, 1.0}},
    }};
    for (std::size_t type = 0; type < 3; ++type) {
        const double printed = mean_error(all, as_published, {type}).percent();
        for (const MethodLine& line : lines) {
            const MeanError error = mean_error(all, line.method, {type});
            const std::string answered =
                error.missing > 0 ? fmt::format(" ({} of {} estimated)", error.count, error.count + error.missing) : "";
            r.figures.push_back({.name = fmt::format("{}: mean error, {}{}", table_name(type), line.name, answered),
                                 .unit = "%",
                                 .published = printed,
                                 .ours = error.percent(),
                                 .judged = line.bound_percent[type] > 0.0 ? Judged::at_most : Judged::shown,
                                 .bound = line.bound_percent[type]});
        }
    }
    const double printed = mean_error(all, as_published, {0, 1, 2}).percent();
    r.figures.push_back({"Tables 5–7: mean error, Table 1 on the resultant, angles against the nominal cut", "%",
                         printed, mean_error(all, against_nominal, {0, 1, 2}).percent(), Judged::at_most, 3.0});
    const MeanError fit = mean_error(all, profile_fit, {0, 1, 2});
    r.figures.push_back({"Tables 5–7: mean error, profile fit", "%", printed, fit.percent(), Judged::at_most, 1.0});
    r.figures.push_back({"Tables 5–7: share of the 60 depths that the profile fit estimates", "", not_published,
                         fit.answered_share(), Judged::at_least, 1.0});
}

/// Mean relative error of the variations beyond 10 %, in percent of the variation.
double relative_error_percent(const std::vector<Series>& all, Method method) {
    constexpr double smallest_variation_percent = 10.0;
    double sum_percent = 0.0;
    double count = 0.0;
    const auto add = [&](double estimate, double truth) {
        if (std::abs(truth) > smallest_variation_percent && std::isfinite(estimate)) {
            sum_percent += 100.0 * std::abs(estimate / truth - 1.0);
            count += 1.0;
        }
    };
    for (const Series& series : all) {
        for (const Test& test : series.tests) {
            add(test.estimate[method].axial, test.truth.axial);
            add(test.estimate[method].radial, test.truth.radial);
        }
    }
    return sum_percent / count;
}

void add_relative_errors(const std::vector<Series>& all, Reproduction& r) {
    constexpr double published_bound_percent = 15.0;
    const double printed = relative_error_percent(all, as_published);
    const auto add = [&](const char* name, Method method) {
        r.figures.push_back({fmt::format("Tables 5–7: mean relative error of variations beyond 10 %, {}", name), "%",
                             printed, relative_error_percent(all, method), Judged::at_most, published_bound_percent});
    };
    add("Table 1 on the resultant, angles against the nominal cut", against_nominal);
    add("profile fit", profile_fit);
}

/// Numbers of the paper's text and of its formulas that need no cut.
void add_formulas(Reproduction& r) {
    const estimation::FluteGeometry<double> mill_1{4, 9.525, 30.0 * degree};
    const estimation::FluteAngles<double> angles{0.0, 32.5 * degree, turn / 4.0};
    const double axial_mm = estimation::depths_of_cut(mill_1, angles).axial_mm;
    r.figures.push_back({"Fig. 16a: δADOC from PT_doc = 32.5°", "%", 22.72,
                         100.0 * (axial_mm / yang_mills[0].nominal_axial_mm[0] - 1.0), Judged::difference, 0.15});
    const auto needed = [](const estimation::FluteGeometry<double>& mill, double axial, double radial) {
        return estimation::samples_per_revolution(mill, estimation::DepthsOfCut<double>{axial, radial}, 0.01);
    };
    r.figures.push_back({"Eq. 13: samples per revolution for all published tests at 1 %", "", 4081.0,
                         needed(mill_1, 2.54, 15.24), Judged::relative_difference, 0.001});
    r.figures.push_back({"Eq. 13: samples per revolution of the paper's example (Ø18.75 mm, not printed)", "", 1021.0,
                         needed({3, 9.375, 30.0 * degree}, 10.0, 10.0), Judged::relative_difference, 0.001});
}

double degrees(float angle_rad) {
    return static_cast<double>(angle_rad) / degree;
}

/// PT_doc of a simulated force against Table 1, where the two agree and where they cannot.
void add_angles(const std::vector<Series>& all, Reproduction& r) {
    constexpr double corner_bound_deg = 1.5;  // filter and vector sum shift a corner by the slopes on its sides
    for (const Series& series : all) {
        const double formula_deg = series.nominal_formula_rad / degree;
        const auto add = [&](const char* what, double force_deg, double bound_deg) {
            r.figures.push_back({fmt::format("{}, mill {}, nominal cut: PT_doc, Table 1 against {}",
                                             table_name(series.type), series.mill + 1, what),
                                 "°", formula_deg, force_deg, bound_deg > 0.0 ? Judged::difference : Judged::shown,
                                 bound_deg});
        };
        const auto& indices = series.nominal_indices;
        if (series.type == 0) {
            add("the force's corners", degrees(indices.valley_to_corner_rad), corner_bound_deg);
        } else if (series.type == 1) {
            const bool flat_top = series.mill == 0;  // II/LO; mill 2 is II/MO
            add("the force's corners",
                degrees(flat_top ? indices.flat_top_to_valley_rad : indices.valley_to_corner_rad), corner_bound_deg);
        } else {
            add("the force's peak", degrees(indices.valley_to_peak_rad), 0.0);
            add("the force's corner", degrees(indices.valley_to_corner_rad), 0.0);
        }
    }
    SteadyCut alone = published_cut(0, 1, {0.0, 0.0});  // II/NO: no published test is one
    constexpr double engagement_deg = 26.46;
    constexpr double sweep_deg = 50.0;
    const auto depths = estimation::depths_of_cut(
        geometry_of(alone.cutter), {single(engagement_deg * degree), single(sweep_deg * degree), single(turn / 4.0)});
    alone.axial_depth_mm = static_cast<double>(depths.axial_mm);
    alone.radial_depth_mm = static_cast<double>(depths.radial_mm);
    ForceSensor sensor;
    sensor.noise_share = 0.0;
    sensor.low_pass_Hz = 0.0;
    const auto record =
        record_force(force_revolution(alone, sensor.samples_per_revolution), sensor, profile_revolutions);
    const auto indices = indices_of(flute_average(record, sensor, alone.cutter.teeth, resultant_N), alone.cutter.teeth);
    r.figures.push_back({"II/NO, α_en = 26.46°, no noise, no filter: PT_doc, Table 1 against the force", "°",
                         engagement_deg, degrees(indices.flat_top_to_valley_rad), Judged::difference,
                         corner_bound_deg});
}

void add_hardness(Reproduction& r) {
    const HardnessEffect effect = hardness_effect();
    r.figures.push_back({"Hardness +20 %: shift of δRDOC by the published method", "%", not_published,
                         effect.published_method.radial, Judged::shown});
    r.figures.push_back({"Hardness +20 %: shift of δADOC by the profile fit", "%", not_published,
                         std::abs(effect.profile_fit.axial), Judged::at_most, 0.1});
    r.figures.push_back({"Hardness +20 %: shift of δRDOC by the profile fit", "%", not_published,
                         std::abs(effect.profile_fit.radial), Judged::at_most, 0.1});
}

std::vector<RandomCutOutcome> add_random_cuts(Reproduction& r) {
    auto outcomes = random_cuts({});
    const RandomCutSummary s = summary_of(outcomes);
    const auto at_most = [&](const char* name, double percent, double bound) {
        r.figures.push_back(
            {fmt::format("1000 random cuts: {}", name), "%", not_published, percent, Judged::at_most, bound});
    };
    at_most("95th percentile of the larger error, no estimate counted as wrong", s.percentile_95_percent, 3.0);
    at_most("the same, down milling", s.percentile_95_down_percent, 3.0);
    at_most("mean error", s.mean_error_percent, 1.0);
    at_most("largest error of an estimate", s.largest_answered_percent, 10.0);
    const auto shown = [&](const std::string& name, const char* unit, double value) {
        r.figures.push_back({name, unit, not_published, value, Judged::shown});
    };
    shown("1000 random cuts: 95th percentile, up milling", "%", s.percentile_95_up_percent);
    r.figures.push_back({"1000 random cuts: share with both depths estimated", "", not_published, s.answered_share,
                         Judged::at_least, 0.95});
    r.figures.push_back({"1000 random cuts: share of depths within two standard deviations", "", not_published,
                         s.within_two_sd_share, Judged::at_least, 0.95});
    r.figures.push_back({"1000 random cuts: categories that occur, of twelve", "", not_published,
                         static_cast<double>(s.categories), Judged::at_least, 12.0});
    const RandomCutSummary more_runout = summary_of(random_cuts({.count = 150, .largest_runout_in_feeds = 0.3}));
    shown("150 random cuts, runout to 0.3 feeds per tooth: mean error", "%", more_runout.mean_error_percent);
    shown("150 random cuts, runout to 0.3 feeds per tooth: share estimated", "", more_runout.answered_share);
    const RandomCutSummary alone = summary_of(random_cuts({.count = 150, .tip_angle_known = false}));
    shown("150 random cuts, tip's angle unknown: mean error", "%", alone.mean_error_percent);
    shown("150 random cuts, tip's angle unknown: share estimated", "", alone.answered_share);
    return outcomes;
}

std::vector<std::string> deviations() {
    return {
        ("The force is the plant's, not a dynamometer's: 1018 steel with K_tc 1800, K_rc 630 N/mm², edge "
         "forces 7.5 and 9 N/mm (the paper prints no coefficients), runout 5 µm, noise of 1 % of the peak, a "
         "two-pole low-pass."),
        ("Valley, peak and end of a flat top are read off as corners of the profile, the same way for all "
         "tests; the paper does not say how it reads them. K comes from the nominal cut of each series, and so "
         "does the offset of PT_doc where a figure says so: filter and vector sum shift the corners by up to "
         "1.5°."),
        ("Eq. 3 prints ADOC_c where the actual ADOC must stand; Eq. 6 prints α_sw < α_T where it needs α_en + "
         "α_sw < α_T."),
        ("Table 1's row for type III is a single flute's peak. Where the next flute enters before it, the sum "
         "peaks elsewhere: for mill 1 (III/MO) at the end of that entry, α_sw after the valley, whether the "
         "flutes are added as scalars or as vectors. For mill 2 (III/LO) the vector sum moves the valley. So "
         "the published formulas do not give the published accuracy on a force that adds as vectors, and Table "
         "7 is shown for them, not judged. With α_sw in that row, flute forces added as scalars do give it."),
        ("Eq. 9's K is the force per area at one hardness and chip thickness. A harder piece looks like a "
         "wider cut; between −20 and +20 % of width the edge forces alone are worth some 2 to 4 % of K."),
        ("The profile fit averages F_x and F_y over the flutes instead of their resultant: a magnitude is not "
         "linear, and keeps some of the runout. It learns the angle of the tooth's tip against the encoder "
         "from the nominal cut, as the published method learns K. Without that it still estimates the axial "
         "depth; the width then depends on where the force ends at the thin end of the chip, where runout "
         "lifts teeth out of the cut."),
        ("A sweep of a whole number of pitches leaves a constant force, whatever the width: physics gives no "
         "estimate there, and the fit says so."),
    };
}

constexpr const char* summary =
    "The force of a helical end mill rises while a flute sweeps into the workpiece and falls while it leaves. The "
    "shape "
    "of one such wave tells how far the axial and the radial depth of cut (ADOC, RDOC) are from their nominal values, "
    "as happens with castings or worn fixtures, and it does so whatever the material's hardness. The force is averaged "
    "over all flutes, which takes runout out. The published method then reads one angle of the wave and its mean; "
    "beside it stands a fit of the whole wave. All 30 published tests are milled here in simulation, and 1000 cuts "
    "drawn at random.";

}  // namespace yang

Reproduction reproduce_yang() {
    Reproduction r{.name = "yang",
                   .title = "Depth-of-cut variation from the shape of the cutting force (Yang, DeVor, Kapoor)",
                   .summary = yang::summary,
                   .figures = {},
                   .plots = {},
                   .deviations = yang::deviations()};
    std::vector<yang::Series> all;
    for (std::size_t type = 0; type < 3; ++type) {
        for (std::size_t mill = 0; mill < 2; ++mill) {
            all.push_back(yang::published_series(mill, type));
        }
    }
    yang::add_means(all, r);
    yang::add_relative_errors(all, r);
    yang::add_formulas(r);
    yang::add_angles(all, r);
    yang::add_hardness(r);
    const auto outcomes = yang::add_random_cuts(r);
    yang::add_rows(all, r);
    r.plots = yang::plots(all, outcomes);
    return r;
}

}  // namespace millforce::sim
