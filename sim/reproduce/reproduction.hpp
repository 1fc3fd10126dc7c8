// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

/// What a paper's system gives here, and what the paper prints. A reproduction is plain data: the command prints it,
/// the report page draws it, the tests judge it.
///
/// A value stands under "paper" only where a reader of the paper finds it in print, or works it out from printed
/// numbers alone. A formula of the paper that this project evaluates, twice even, is a check of our own.

namespace millforce::sim {

/// One published figure and ours, or a check of our own.
struct Figure {
    std::string name;  ///< name of a published value: first where the paper prints it, "Table 5, carbide: k_s"
    std::string unit;  ///< "" for a ratio, a count, an exponent
    double published;  ///< NaN in a check of our own
    double ours;
    enum class Judged {
        difference,           ///< |ours − published| ≤ bound, in the figure's unit
        relative_difference,  ///< |ours / published − 1| ≤ bound
        at_most,              ///< ours ≤ bound (an error)
        at_least,             ///< ours ≥ bound (a share)
        within,               ///< bound_low ≤ ours ≤ bound (a coverage)
        shown,                ///< no bound: shown for comparison only
    } judged = Judged::difference;
    double bound = 0.0;
    double bound_low = 0.0;
    std::string reason{};  ///< why a published figure has no bound, or why ours lies elsewhere

    [[nodiscard]] bool holds() const;              ///< false for NaN, unless it is only shown
    [[nodiscard]] std::string difference() const;  ///< as printed: "+1.3 %", "−0.02", "" without a published value
    [[nodiscard]] std::string bound_text() const;  ///< as printed: "± 3 %", "≤ 0.10", ""
};

/// A check of our own: a promise about this project's value, or a value of interest.
[[nodiscard]] Figure own_check(std::string name, std::string unit, double value,
                               Figure::Judged judged = Figure::Judged::shown, double bound = 0.0,
                               double bound_low = 0.0);

/// A drawing of the report page.
struct Plot {
    struct Series {
        std::string name;
        enum class Style { line, points, band_low, band_high } style = Style::line;
        std::vector<double> x;
        std::vector<double> y;
    };
    std::string title;  ///< what it shows and the paper's figure: "Tooth force against rotation (Fig. 9)"
    std::string x_label;
    std::string y_label;
    std::string caption;  ///< what to see in it, readable without the paper
    std::vector<Series> series;
};

/// Something in the paper that does not stand here.
struct NotReproduced {
    std::string what;  ///< "Figs. 9–14: measured points"
    std::string why;
};

/// A paper in full.
struct PaperSource {
    std::string citation{};
    std::string doi{};  ///< empty: not known
};

struct Reproduction {
    std::string name;   ///< as typed: "hwang"
    std::string title;  ///< what the system is, with the paper's authors
    PaperSource source{};
    std::string summary{};         ///< one paragraph: what the system does, readable without the paper
    std::vector<Figure> figures;   ///< each with a published value; one that is only shown has a reason
    std::vector<Figure> checks{};  ///< figures of our own, without a published value
    std::vector<Plot> plots;
    std::vector<std::string> deviations;  ///< where this project differs from print, and why
    std::vector<NotReproduced> not_reproduced{};
    [[nodiscard]] bool holds() const;
};

/// The systems. Deterministic: every random number is seeded.
[[nodiscard]] Reproduction reproduce_hwang();
[[nodiscard]] Reproduction reproduce_yang();
[[nodiscard]] Reproduction reproduce_kim();
[[nodiscard]] Reproduction reproduce_roughness();
[[nodiscard]] Reproduction reproduce_guan();

}  // namespace millforce::sim
