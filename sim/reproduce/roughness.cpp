// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduction.hpp"

#include "cutting/angle_units.hpp"
#include "estimation_calibration/roughness_fit.hpp"
#include "estimation_calibration/roughness_in_double.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

/// Tangjitsitcharoen & Senjuntichaj: the two published models, tests made with them, and what a fit makes of the tests.
/// The paper prints no measured value, no scatter, no range of F_x/F_z: those are assumed, and said to be.

namespace millforce::sim {
namespace roughness_reproduction {
namespace {

using Cut = estimation::RoughnessConditions<double>;
using Model = estimation::RoughnessModel<double>;
using Test = estimation::RoughnessTest;
using Predictor = estimation::RoughnessPredictor<double>;
using Series = Plot::Series;
using Judged = Figure::Judged;

constexpr double assumed_ln_scatter = 0.15;
constexpr double smallest_ratio = 0.5;  // assumed: Fig. 2 shows the ratio, the text does not give its range
constexpr double largest_ratio = 1.5;
constexpr std::array<double, 3> speeds_rpm{8000.0, 10000.0, 12000.0};  // Table 1
constexpr std::array<double, 2> feeds_mm_rev{0.01, 0.03};
constexpr std::array<double, 3> diameters_mm{4.0, 6.0, 8.0};
constexpr std::array<double, 2> depths_mm{0.3, 0.5};
constexpr std::array<const char*, 5> symbols{"V", "f", "φ", "D", "F_x/F_z"};

struct Published {
    const char* name;
    const char* equation;
    unsigned seed;
    Model model;
};

std::array<Published, 2> published() {
    Model Ra;
    Ra.constant_um = 7.5e-6;
    Ra.exponent = {0.964, 0.195, 2.69, 0.917, -2.6};
    Model Rz;
    Rz.measure = estimation::RoughnessMeasure::Rz;
    Rz.constant_um = 2.91;
    Rz.exponent = {0.16, 0.438, 1.25, 0.474, -2.84};
    return {{{"R_a", "Eq. 3", 10U, Ra}, {"R_z", "Eq. 4", 20U, Rz}}};
}

/// Seeded, and the same on every platform: the distributions of <random> are not.
class Scatter {
  public:
    explicit Scatter(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) + 0.5) / 4294967296.0;
    }
    /// Box–Muller.
    double normal(double sd) {
        const double radius = std::sqrt(-2.0 * std::log(uniform(0.0, 1.0)));
        return sd * radius * std::cos(uniform(0.0, turn));
    }

  private:
    std::mt19937 engine_;
};

double by_power_law_um(const Model& model, const Cut& cut) {
    double R = model.constant_um;
    for (std::size_t j = 0; j < cut.size(); ++j) {
        R *= std::pow(cut[j], model.exponent[j]);
    }
    return R;
}

/// A cutting test: R as the model gives it, with the scatter of a measured surface.
Test made_with(const Model& model, const Cut& cut, Scatter& scatter) {
    return {cut, by_power_law_um(model, cut) * std::exp(scatter.normal(assumed_ln_scatter))};
}

/// Every combination of Table 1: 36 tests.
std::vector<Test> table_1(const Model& model, Scatter& scatter) {
    std::vector<Test> tests;
    for (const double V : speeds_rpm) {
        for (const double f : feeds_mm_rev) {
            for (const double phi : diameters_mm) {
                for (const double D : depths_mm) {
                    tests.push_back(
                        made_with(model, {V, f, phi, D, scatter.uniform(smallest_ratio, largest_ratio)}, scatter));
                }
            }
        }
    }
    return tests;
}

/// A new test within the conditions of Table 1, at none of its levels.
Test held_out(const Model& model, Scatter& scatter) {
    const Cut cut{scatter.uniform(speeds_rpm.front(), speeds_rpm.back()),
                  scatter.uniform(feeds_mm_rev.front(), feeds_mm_rev.back()),
                  scatter.uniform(diameters_mm.front(), diameters_mm.back()),
                  scatter.uniform(depths_mm.front(), depths_mm.back()), scatter.uniform(smallest_ratio, largest_ratio)};
    return made_with(model, cut, scatter);
}

estimation::RoughnessFit fit(const std::vector<Test>& tests) {
    return estimation::fit_roughness(tests);
}

bool is_covered(const Predictor& predictor, const Test& test) {
    const auto prediction = predictor.predict(test.cut);
    return test.roughness_um >= prediction.low_um && test.roughness_um <= prediction.high_um;
}

/// Each exponent over many series of tests: where it lies on average, and how often within two standard errors. Of one
/// series one exponent in twenty lies outside, whatever the method; a single series proves little.
void add_exponents(const Published& paper, Reproduction& result) {
    Scatter scatter(paper.seed + 1U);
    constexpr int series = 4000;
    std::array<double, 5> sum{};
    std::array<double, 5> sum_of_errors{};
    std::array<int, 5> within{};
    for (int k = 0; k < series; ++k) {
        const auto found = fit(table_1(paper.model, scatter));
        for (std::size_t j = 0; j < symbols.size(); ++j) {
            const double error = found.model.exponent[j] - paper.model.exponent[j];
            sum[j] += found.model.exponent[j];
            sum_of_errors[j] += found.exponent_standard_error[j];
            within[j] += std::abs(error) <= 2.0 * found.exponent_standard_error[j] ? 1 : 0;
        }
    }
    for (std::size_t j = 0; j < symbols.size(); ++j) {
        const double standard_error = sum_of_errors[j] / series;
        result.figures.push_back(
            {fmt::format("{}: exponent of {}, found again in tests made with it: mean of {} series of 36 tests "
                         "(standard error of one: {:.3f}; bound: a tenth of it)",
                         paper.equation, symbols[j], series, standard_error),
             "", paper.model.exponent[j], sum[j] / series, Judged::difference, 0.1 * standard_error});
        result.checks.push_back(
            own_check(fmt::format("{}: exponent of {}, series in which it is recovered within two standard errors "
                                  "(Student's t: 94.5 %)",
                                  paper.equation, symbols[j]),
                      "%", 100.0 * within[j] / series, Judged::within, 97.0, 93.0));
    }
}

/// Coverage of the 95 % prediction interval: a new series of tests and a new held-out test each time.
void add_coverage(const Published& paper, Reproduction& result) {
    Scatter scatter(paper.seed + 2U);
    constexpr int held_out_tests = 1000;
    int covered = 0;
    for (int k = 0; k < held_out_tests; ++k) {
        const Predictor predictor(fit(table_1(paper.model, scatter)).model);
        covered += is_covered(predictor, held_out(paper.model, scatter)) ? 1 : 0;
    }
    result.figures.push_back(
        {fmt::format("Section 4.2, {}: 95 % prediction interval; ours: held-out tests in theirs, {} "
                     "tests, each from a series of its own",
                     paper.equation, held_out_tests),
         "%", 95.0, 100.0 * covered / held_out_tests, Judged::within, 97.0, 93.0});
    const Predictor one(fit(table_1(paper.model, scatter)).model);
    covered = 0;
    for (int k = 0; k < held_out_tests; ++k) {
        covered += is_covered(one, held_out(paper.model, scatter)) ? 1 : 0;
    }
    result.checks.push_back(own_check(
        fmt::format("{}: {} held-out tests in their 95 % interval, all from one series of 36 tests: s is then "
                    "known to 13 % only",
                    paper.equation, held_out_tests),
        "%", 100.0 * covered / held_out_tests));
}

/// The chain of the loop: forces from currents with 3 % of noise, in float.
void add_loop_coverage(const Published& paper, Reproduction& result) {
    Scatter scatter(paper.seed + 3U);
    constexpr int held_out_tests = 1000;
    constexpr double force_sd = 0.03;
    int covered = 0;
    for (int k = 0; k < held_out_tests; ++k) {
        const estimation::RoughnessPredictor<float> predictor(
            estimation::in_float(fit(table_1(paper.model, scatter)).model));
        const Test test = held_out(paper.model, scatter);
        estimation::RoughnessConditions<float> cut{};
        std::transform(test.cut.begin(), test.cut.end(), cut.begin(),
                       [](double value) { return static_cast<float>(value); });
        const auto measured = [&](double force_N) {
            const double sd_N = force_sd * std::abs(force_N);
            return estimation::Measurement<float>{true, static_cast<float>(force_N + scatter.normal(sd_N)),
                                                  static_cast<float>(sd_N * sd_N), 0.0F};
        };
        const auto prediction =
            predictor.predict(cut, measured(20.0 * test.cut[estimation::roughness_force_ratio]), measured(-20.0));
        const double low = static_cast<double>(prediction.low_um);
        const double high = static_cast<double>(prediction.high_um);
        covered += test.roughness_um >= low && test.roughness_um <= high ? 1 : 0;
    }
    result.checks.push_back(
        own_check(fmt::format("{}: held-out tests in their 95 % interval, in float, with F_x and F_z "
                              "known to {:.0f} % each",
                              paper.equation, 100.0 * force_sd),
                  "%", 100.0 * covered / held_out_tests, Judged::within, 97.0, 93.0));
}

/// Fig. 2 in kind: R_a over the ratio at V 10 000 rpm, f 0.03 mm/rev, D 0.3 mm.
void add_figure_2(const Published& paper, Reproduction& result) {
    Plot plot{fmt::format("{} over the cutting force ratio (Fig. 2)", paper.name),
              "F_x/F_z",
              fmt::format("{} in µm", paper.name),
              "V 10 000 rpm, f 0.03 mm/rev, D 0.3 mm. Lines: the published model for each tool diameter. Points: tests "
              "made with it. The larger the ratio, the smoother the surface.",
              {}};
    Scatter scatter(paper.seed + 4U);
    for (const double phi : diameters_mm) {
        Series line{fmt::format("Ø{:g} mm, model", phi), Series::Style::line, {}, {}};
        Series points{fmt::format("Ø{:g} mm, tests", phi), Series::Style::points, {}, {}};
        for (int k = 0; k <= 50; ++k) {
            const double ratio = smallest_ratio + (largest_ratio - smallest_ratio) * k / 50.0;
            line.x.push_back(ratio);
            line.y.push_back(by_power_law_um(paper.model, {1e4, 0.03, phi, 0.3, ratio}));
            if (k % 5 == 0) {
                points.x.push_back(ratio);
                points.y.push_back(made_with(paper.model, {1e4, 0.03, phi, 0.3, ratio}, scatter).roughness_um);
            }
        }
        plot.series.push_back(line);
        plot.series.push_back(points);
    }
    result.plots.push_back(plot);
}

/// Figs. 3 and 4 in kind: new tests, measured and predicted, with the prediction interval.
void add_figures_3_and_4(const Published& paper, const char* where, Reproduction& result) {
    Scatter scatter(paper.seed + 5U);
    const Predictor predictor(fit(table_1(paper.model, scatter)).model);
    constexpr int new_tests = 30;
    std::vector<Test> tests(new_tests);
    std::generate(tests.begin(), tests.end(), [&] { return held_out(paper.model, scatter); });
    std::sort(tests.begin(), tests.end(), [&](const Test& a, const Test& b) {
        return predictor.predict(a.cut).roughness_um < predictor.predict(b.cut).roughness_um;
    });
    Series measured{"measured (simulated test)", Series::Style::points, {}, {}};
    Series predicted{"predicted", Series::Style::line, {}, {}};
    Series low{"95 % interval, lower bound", Series::Style::band_low, {}, {}};
    Series high{"95 % interval, upper bound", Series::Style::band_high, {}, {}};
    for (std::size_t k = 0; k < tests.size(); ++k) {
        const auto prediction = predictor.predict(tests[k].cut);
        const double number = static_cast<double>(k + 1);
        for (Series* series : {&measured, &predicted, &low, &high}) {
            series->x.push_back(number);
        }
        measured.y.push_back(tests[k].roughness_um);
        predicted.y.push_back(prediction.roughness_um);
        low.y.push_back(prediction.low_um);
        high.y.push_back(prediction.high_um);
    }
    result.plots.push_back(
        {fmt::format("{} of {} new tests, measured and predicted ({})", paper.name, new_tests, where),
         "test, by predicted roughness",
         fmt::format("{} in µm", paper.name),
         "The model was fitted to 36 other tests. One new test in twenty is to fall outside of the "
         "band.",
         {low, high, predicted, measured}});
}

/// R_z/R_a by the two published models over Table 1, at the ratio 1.
void add_consistency(const std::array<Published, 2>& papers, Reproduction& result) {
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (const double V : speeds_rpm) {
        for (const double f : feeds_mm_rev) {
            for (const double phi : diameters_mm) {
                for (const double D : depths_mm) {
                    const Cut cut{V, f, phi, D, 1.0};
                    const double quotient =
                        by_power_law_um(papers[1].model, cut) / by_power_law_um(papers[0].model, cut);
                    smallest = std::min(smallest, quotient);
                    largest = std::max(largest, quotient);
                }
            }
        }
    }
    result.checks.push_back(own_check("Eqs. 3 and 4: smallest R_z/R_a over Table 1, at F_x/F_z = 1", "", smallest));
    result.checks.push_back(own_check("Eqs. 3 and 4: largest R_z/R_a over Table 1, at F_x/F_z = 1", "", largest));
    result.deviations.push_back(fmt::format(
        "The two published models together give R_z/R_a from {:.1f} to {:.0f} over Table 1, mostly by the tool "
        "diameter's exponents (2.69 and 1.25). Milled surfaces have some 4 to 8: at small diameters the two models "
        "cannot both be right. Both are kept as printed.",
        smallest, largest));
}

constexpr const char* summary =
    "How smooth a ball-end-milled surface becomes is predicted while it is cut, from spindle speed, feed, tool "
    "diameter, depth and the ratio of two cutting forces, F_x/F_z: a power law whose exponents are fitted to cutting "
    "tests. Each prediction comes with the interval that should hold 95 of 100 new surfaces. Here tests are made "
    "from the published law with a stated scatter, the law is fitted to them again, and new tests show whether the "
    "interval holds what it promises.";

}  // namespace
}  // namespace roughness_reproduction

Reproduction reproduce_roughness() {
    using namespace roughness_reproduction;
    Reproduction result;
    result.name = "roughness";
    result.title =
        "Surface roughness from the cutting force ratio in ball-end milling (Tangjitsitcharoen & Senjuntichaj)";
    result.source = {
        "S. Tangjitsitcharoen, A. Senjuntichaj: In-process Monitoring and Prediction of Surface Roughness in Ball-End "
        "Milling Process. Venue and year are not printed on the copy used; the work was funded from October 2008 to "
        "September 2010."};
    result.summary = summary;
    const auto papers = published();
    for (const Published& paper : papers) {
        add_exponents(paper, result);
        add_coverage(paper, result);
        add_loop_coverage(paper, result);
    }
    add_consistency(papers, result);
    add_figure_2(papers[0], result);
    add_figures_3_and_4(papers[1], "Fig. 3", result);
    add_figures_3_and_4(papers[0], "Fig. 4", result);
    const std::array<const char*, 6> deviations{
        "The paper calls its power law an exponential function, and names the steel AISI 1045 in the text, 1050 in "
        "Table 1.",
        "It prints no measured roughness, no scatter, no number of tests and no range of F_x/F_z. Here: all 36 "
        "combinations of Table 1, ln R scattering by 0.15, the ratio from 0.5 to 1.5. The published models enter the "
        "tool library without an interval, and with no stated range for the ratio.",
        "It draws the 95 % prediction interval and prints no formula. Here: Student's t with n − p degrees of "
        "freedom and the leverage of the cut, in logarithms; so it is not symmetric in R, and R itself is the "
        "median.",
        "The paper's forces come from a dynamometer. Here F_z is the z drive's current: the doubt of both forces is "
        "added to the interval, and where z stands there is no prediction, since a standing drive hides force in "
        "friction.",
        "F_x is called the tangential force there. Here it is the force along the feed, whose drive moves.",
        "A coverage holds over series of tests. Of one series of 36 the interval may cover less or more, since its "
        "own s is known to 13 % only: it is shown beside.",
    };
    result.deviations.insert(result.deviations.begin(), deviations.begin(), deviations.end());
    result.not_reproduced = {
        {"Figs. 2–4: measured roughness",
         "the text that this project has holds no images, and the paper prints no measured value. So the printed "
         "models are not tested against a surface here: tests are made with them, and the fit must find them again."},
        {"Section 4.2: P-value 0.000", "it is that of the paper's own tests, which are not printed."},
        {"Fig. 1", "a sketch of the bench: it shows no data."},
    };
    return result;
}

}  // namespace millforce::sim
