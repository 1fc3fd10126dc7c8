// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reproduce/reproduction.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

/// What every paper's reproduction owes its reader.

namespace millforce::test {

using sim::Figure;
using sim::Reproduction;

inline void check_that_all_bounds_hold(const Reproduction& paper) {
    for (const std::vector<Figure>* all : {&paper.figures, &paper.checks}) {
        for (const Figure& figure : *all) {
            const std::string text = figure.name + ": " + std::to_string(figure.ours) + " " + figure.bound_text();
            CHECK_TEXT(figure.holds(), text.c_str());
        }
    }
}

inline bool names_a_place_in_print(std::string_view name) {
    constexpr std::array<std::string_view, 7> places{"Eq. ",     "Eqs. ",  "Fig. ",  "Figs. ",
                                                     "Section ", "Table ", "Tables "};
    return std::any_of(places.begin(), places.end(), [&](std::string_view place) { return name.starts_with(place); });
}

/// Papers print few digits. A value with more comes from a formula, and belongs among our own checks, unless it is a
/// mean of printed numbers or a comparison of two.
inline bool has_digits_of_print(const Figure& figure) {
    const double in_last_digits = figure.published * 1e5;
    return std::abs(in_last_digits - std::round(in_last_digits)) < 1e-6 ||
           figure.name.find("mean") != std::string::npos || figure.name.find("against") != std::string::npos;
}

/// Under "paper" stands what a reader finds in the paper, and nothing of ours.
inline void check_that_published_values_are_printed(const Reproduction& paper) {
    for (const Figure& figure : paper.figures) {
        CHECK_TEXT(std::isfinite(figure.published), figure.name.c_str());
        CHECK_TEXT(names_a_place_in_print(figure.name), figure.name.c_str());
        CHECK_TEXT(has_digits_of_print(figure), figure.name.c_str());
    }
    for (const Figure& check : paper.checks) {
        CHECK_TEXT(std::isnan(check.published), check.name.c_str());
    }
}

inline void check_that_every_gap_has_a_reason(const Reproduction& paper) {
    for (const Figure& figure : paper.figures) {
        CHECK_TEXT(figure.judged != Figure::Judged::shown || !figure.reason.empty(), figure.name.c_str());
    }
    CHECK(!paper.not_reproduced.empty());
    for (const auto& [what, why] : paper.not_reproduced) {
        CHECK(!what.empty());
        CHECK_TEXT(!why.empty(), what.c_str());
    }
}

inline void check_that_plots_can_be_drawn(const Reproduction& paper) {
    for (const sim::Plot& plot : paper.plots) {
        CHECK_TEXT(!plot.caption.empty(), plot.title.c_str());
        CHECK_TEXT(!plot.series.empty(), plot.title.c_str());
        for (const sim::Plot::Series& series : plot.series) {
            CHECK_TEXT(!series.x.empty(), plot.title.c_str());
            CHECK_EQUAL(series.x.size(), series.y.size());
            const bool is_finite =
                std::all_of(series.x.begin(), series.x.end(), [](double x) { return std::isfinite(x); });
            CHECK_TEXT(is_finite, plot.title.c_str());
        }
    }
}

inline void check_reproduction(const Reproduction& paper) {
    check_that_all_bounds_hold(paper);
    check_that_published_values_are_printed(paper);
    check_that_every_gap_has_a_reason(paper);
    check_that_plots_can_be_drawn(paper);
}

/// "Fig. 1" is not in the title of "Fig. 13".
inline bool has_in_title(const sim::Plot& plot, const std::string& figure) {
    const std::size_t start = plot.title.find(figure);
    const std::size_t end = start + figure.size();
    return start != std::string::npos &&
           (end == plot.title.size() || std::isdigit(static_cast<unsigned char>(plot.title[end])) == 0);
}

inline void check_that_figures_are_drawn(const Reproduction& paper, const std::vector<std::string>& figures) {
    for (const std::string& figure : figures) {
        const bool is_drawn = std::any_of(paper.plots.begin(), paper.plots.end(),
                                          [&](const sim::Plot& plot) { return has_in_title(plot, figure); });
        CHECK_TEXT(is_drawn, figure.c_str());
    }
}

/// How many have a name that begins so.
inline long count_beginning_with(const std::vector<Figure>& figures, const std::string& start) {
    return std::count_if(figures.begin(), figures.end(),
                         [&](const Figure& figure) { return figure.name.starts_with(start); });
}

inline long count_judged(const std::vector<Figure>& figures) {
    return std::count_if(figures.begin(), figures.end(),
                         [](const Figure& figure) { return figure.judged != Figure::Judged::shown; });
}

}  // namespace millforce::test
