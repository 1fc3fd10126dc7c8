// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// Every kind of figure and series, a check of our own, text that must be escaped, and values that are not numbers.
inline Reproduction paper_with_everything() {
    using Judged = Figure::Judged;
    using Style = Plot::Series::Style;
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Reproduction paper{.name = "everything",
                       .title = "A made-up paper: force <of> & on a tool",
                       .figures = {},
                       .plots = {},
                       .deviations = {"Printed with a slip."}};
    paper.source = {"A. Nobody & B. Else: On a tool. Journal 3 (2001) 4–5.", "10.1000/182"};
    paper.summary = "What it does.";
    paper.figures = {{"Eq. 1: difference", "N", 10.0, 10.5, Judged::difference, 1.0},
                     {"Eq. 1: relative <difference>", "mm", 100.0, 98.0, Judged::relative_difference, 0.05},
                     {"Eq. 2: an error", "%", 2.0, 1.5, Judged::at_most, 3.0},
                     {"Eq. 3: a share", "", 0.9, 0.95, Judged::at_least, 0.9},
                     {"Eq. 4: a coverage", "", 0.95, 0.94, Judged::within, 0.97, 0.93},
                     {"Eq. 5: no value of ours", "", 1.0, none, Judged::shown, 0.0, 0.0, "not <measured> here."}};
    paper.checks = {own_check("Eq. 6: a promise", "mm", 0.25, Judged::at_most, 1.0), own_check("a look", "N", 12.0)};
    paper.not_reproduced = {{"Fig. 7: <points>", "they are not printed."}};
    paper.plots = {{"Force over angle",
                    "angle, °",
                    "force <N>",
                    "What to see.",
                    {{"ours", Style::line, {0.0, 1.0, 2.0}, {1.0, none, 3.0}},
                     {"paper's", Style::points, {0.0, 1.0}, {1.0, 2.0}},
                     {"band, below", Style::band_low, {0.0, 1.0}, {0.5, 1.0}},
                     {"band, above", Style::band_high, {0.0, 1.0}, {1.5, 3.0}}}}};
    return paper;
}

/// 20 equal rows, the tenth beyond its bound where asked for, and two figures after them.
inline Reproduction paper_with_a_long_table(bool is_broken) {
    Reproduction paper{.name = "long", .title = "A long table", .figures = {}, .plots = {}, .deviations = {}};
    for (int row = 1; row <= 20; ++row) {
        const double error = is_broken && row == 10 ? 9.0 : 0.1 * row;
        paper.figures.push_back(
            {"Table 1, row " + std::to_string(row) + ": error", "%", 2.5, error, Figure::Judged::at_most, 4.0});
    }
    paper.figures.push_back({"Mean error", "%", 2.5, 1.0, Figure::Judged::at_most, 4.0});
    paper.figures.push_back({"Its scatter", "%", 2.5, 1.0, Figure::Judged::shown});
    return paper;
}

}  // namespace millforce::sim
