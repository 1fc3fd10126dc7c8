// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "reproduce/reproduction.hpp"
#include "reproduce/yang_checks.hpp"
#include "reproduce/yang_equations.hpp"
#include "reproduce/yang_plots.hpp"
#include "reproduce/yang_published.hpp"
#include "reproduce/yang_tables.hpp"

/// Depth-of-cut variation from the force's shape (Yang, DeVor & Kapoor): the published tests, by the published method
/// and by the fit of the whole profile.

namespace millforce::sim {
namespace yang {

using Judged = Figure::Judged;

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
    std::array<double, 3> bound_percent;               ///< by type; 0: shown
    std::array<const char*, 3> reason = {"", "", ""};  ///< where it is shown
};

constexpr const char* why_not_type_III =
    "Table 1's row for type III is the peak of a single flute. Where the next flute enters before it, the sum peaks "
    "elsewhere: for mill 1 at α_sw after the valley. As vectors, mill 2's flutes also move the valley. With α_sw in "
    "its place (below) the method reaches the paper's accuracy.";

/// Mean absolute error per table and method. Type III is judged where Table 1's row for it can hold.
void add_means(const std::vector<Series>& all, Reproduction& r) {
    constexpr std::array<MethodLine, 5> lines = {{
        {against_nominal,
         "the published method: Table 1 on the resultant, angles against the nominal cut",
         {3.0, 3.0, 0.0},
         {"", "", why_not_type_III}},
        {printed_on_vectors,
         "Table 1 on the resultant, angles as read",
         {0.0, 3.0, 0.0},
         {"filter and vector sum shift the force's corners by up to 1.5°, which the row above takes off.", "",
          "the same, and the shift of the corners."}},
        {printed_on_scalars,
         "Table 1 on flute forces added as scalars",
         {3.0, 3.0, 0.0},
         {"", "", "the same: Table 1's row is not the peak of this sum either."}},
        {corrected_on_scalars, "III/LO, III/MO by α_sw, on flute forces added as scalars", {3.0, 3.0, 3.0}},
        {profile_fit, "profile fit (ours)", {1.0, 1.0, 1.0}},
    }};
    for (std::size_t type = 0; type < 3; ++type) {
        const double printed = mean_error(all, as_published, {type}).percent();
        for (const MethodLine& line : lines) {
            const MeanError error = mean_error(all, line.method, {type});
            const double bound = line.bound_percent[type];
            r.figures.push_back({fmt::format("{}: mean error, {}{}", table_name(type), line.name, error.missing_text()),
                                 "%", printed, error.percent(), bound > 0.0 ? Judged::at_most : Judged::shown, bound,
                                 0.0, line.reason[type]});
        }
    }
    const double printed = mean_error(all, as_published, {0, 1, 2}).percent();
    r.figures.push_back({"Tables 5–7: mean error, the published method", "%", printed,
                         mean_error(all, against_nominal, {0, 1, 2}).percent(), Judged::at_most, 3.0});
    r.figures.push_back({"Tables 5–7: mean error, profile fit (ours)", "%", printed,
                         mean_error(all, profile_fit, {0, 1, 2}).percent(), Judged::at_most, 1.0});
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
    add("the published method", against_nominal);
    add("profile fit (ours)", profile_fit);
}

double samples_needed(const Mill& mill, const Depths& nominal) {
    constexpr double resolution = 0.01;
    return estimation::samples_per_revolution(mill, nominal, resolution);
}

/// Eq. 13, section 3: the published tests, and the paper's example, whose diameter is not printed.
void add_sampling(Reproduction& r) {
    double needed = 0.0;
    for (const YangMill& table : yang_mills) {
        const Mill mill{static_cast<int>(table.flutes), 0.5 * table.diameter_mm, table.helix_deg * degree};
        for (std::size_t type = 0; type < 3; ++type) {
            needed =
                std::max(needed, samples_needed(mill, {table.nominal_axial_mm[type], table.nominal_radial_mm[type]}));
        }
    }
    r.figures.push_back({"Section 3, Eq. 13: samples per revolution for all published tests at 1 %", "", 4081.0, needed,
                         Judged::relative_difference, 0.001});
    constexpr double resolution = 0.01;
    constexpr double by_axial_depth = 1021.0;
    const Depths example{10.0, 10.0};
    Mill mill{3, 1.0, 30.0 * degree};
    mill.cutter_radius_mm = by_axial_depth * resolution * example.axial_mm * std::tan(mill.helix_rad) / turn;
    const double by_radial_depth = turn / small_engagement_change_rad(mill, example, resolution);
    r.figures.push_back(
        {fmt::format("Section 2, Eqs. 12 and 13: example's samples per revolution by its radial depth, for Ø{:.2f} mm",
                     2.0 * mill.cutter_radius_mm),
         "", 587.0, by_radial_depth, Judged::relative_difference, 0.005, 0.0,
         "the example's diameter is not printed: it is the one that gives the printed 1021 by the axial depth."});
}

/// The example of Fig. 16a: test 4 of mill 1, type I.
void add_figure_16a(Reproduction& r) {
    const Mill mill{4, 0.5 * yang_mills[0].diameter_mm, yang_mills[0].helix_deg * degree};
    constexpr double published_PT_doc_deg = 32.5;
    const estimation::FluteAngles<double> angles{0.0, published_PT_doc_deg * degree, turn / 4.0};
    const double axial_mm = estimation::depths_of_cut(mill, angles).axial_mm;
    r.figures.push_back({"Section 3, Fig. 16a: δADOC by Eqs. 5 and 8 from the printed PT_doc", "%", 22.72,
                         100.0 * (axial_mm / yang_mills[0].nominal_axial_mm[0] - 1.0), Judged::difference, 0.15});
    const TestIndices measured = test_indices(0, 0, 3);
    r.figures.push_back({"Section 3, Fig. 16a: PT_doc, ours of the simulated force against its nominal cut's", "°",
                         published_PT_doc_deg, measured.PT_doc_deg, Judged::difference, corner_bound_deg});
    r.figures.push_back(
        {"Section 3, Fig. 16a: PT_ave", "N", 542.2, measured.PT_ave_N, Judged::shown, 0.0, 0.0,
         "it grows with the material's cutting pressure, which the paper does not print: assumed here."});
}

/// What the paper says of its types in numbers.
void add_types(Reproduction& r) {
    int right = 0;
    double largest_critical_depth = 0.0;
    for (const YangMill& table : yang_mills) {
        const Mill mill{static_cast<int>(table.flutes), 0.5 * table.diameter_mm, table.helix_deg * degree};
        largest_critical_depth = std::max(largest_critical_depth, std::numbers::pi / std::tan(mill.helix_rad));
        for (std::size_t type = 0; type < 3; ++type) {
            for (std::size_t t = 0; t < table.axial_variation_percent.size(); ++t) {
                const Depths depths{table.nominal_axial_mm[type] * (1.0 + 0.01 * table.axial_variation_percent[t]),
                                    table.nominal_radial_mm[type] * (1.0 + 0.01 * table.radial_variation_percent[t])};
                const auto category = estimation::cut_category(estimation::flute_angles(mill, depths));
                right += static_cast<std::size_t>(category.type) == type ? 1 : 0;
            }
        }
    }
    r.figures.push_back({"Tables 5–7, Fig. 8: tests that Eqs. 2 and 3 put into their table's type", "", 30.0,
                         static_cast<double>(right), Judged::at_least, 30.0});
    r.figures.push_back({"Section 2.2.1, Fig. 8: ADOC/R from which on all cuts are of type II, helix 30° and 50°", "",
                         6.0, largest_critical_depth, Judged::at_most, 6.0});
}

void add_numbers_of_the_text(Reproduction& r) {
    add_figure_16a(r);
    add_sampling(r);
    add_types(r);
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
        ("Two more rows of Table 1 miss the sum's peak, and no published test lies in them: II/HO, where the sum rises "
         "until the flute before falls, α_sw − α_T after the valley, and III/HO, as III/MO at α_sw, less whole "
         "pitches."),
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

std::vector<NotReproduced> not_reproduced() {
    return {
        {"Fig. 16: measured forces",
         "the text that this project has holds no images. Drawn instead: the same tests cut by the plant. The two "
         "numbers that the text prints beside Fig. 16a are compared above."},
        {"Tables 5–7 by the paper's own forces",
         "they are not printed. The tests are cut by the plant instead, with Tables 2–4's mills and depths."},
        {"Figs. 1–4, 9 and 12", "sketches that define angles: they show no data."},
    };
}

constexpr const char* summary =
    "The force of a helical end mill rises while a flute sweeps into the workpiece and falls while it leaves. The "
    "shape of one such wave shows how far the axial and the radial depth of cut (ADOC, RDOC) are from their nominal "
    "values, as happens with castings or worn fixtures, and it does so whatever the material's hardness. The force "
    "is averaged over all flutes, which takes runout out. The published method then reads one angle of the wave and "
    "its mean; beside it stands a fit of the whole wave. All 30 published tests are milled here in simulation, and "
    "1000 cuts drawn at random.";

}  // namespace yang

Reproduction reproduce_yang() {
    Reproduction r{
        .name = "yang",
        .title = "Depth-of-cut variation from the shape of the cutting force (Yang, DeVor, Kapoor)",
        .source = {"L. Yang, R. E. DeVor, S. G. Kapoor: Analysis of Force Shape Characteristics and Detection "
                   "of Depth-of-Cut Variations in End Milling. ASME Journal of Manufacturing Science and "
                   "Engineering 127(3) (2005) 454–462.",
                   "10.1115/1.1947207"},
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
    yang::add_numbers_of_the_text(r);
    yang::add_rows(all, r);
    yang::check_equations(r);
    yang::check_angles(all, r);
    yang::check_profile_fit(all, r);
    const auto outcomes = yang::check_random_cuts(r);
    r.plots = yang::plots(all, outcomes);
    r.not_reproduced = yang::not_reproduced();
    return r;
}

}  // namespace millforce::sim
