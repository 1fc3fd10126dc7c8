// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_side.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace millforce::host {

namespace {

using estimation::CutSide;
using estimation::CuttingFit;

std::string_view name_of(CutSide side) {
    return side == CutSide::up ? "up" : "down";
}

/// The cuts as if they had been made on this side, with forces as measured or with the sign of one column turned.
struct Reading {
    CutSide side = CutSide::down;
    std::string_view turned_column;  ///< empty: as measured
    CuttingFit fit{};

    [[nodiscard]] double r_1() const { return fit.parameters(estimation::cutting_r_1); }
    [[nodiscard]] double scatter() const { return plane_scatter(fit); }
    [[nodiscard]] bool is_fitted() const { return fit.undetermined == 0U && fit.converged; }
    /// An edge pushes, and the forces follow the law.
    [[nodiscard]] bool is_possible() const { return is_fitted() && r_1() > 0.0 && scatter() < largest_scatter; }
    [[nodiscard]] bool has_usual_ratio() const {
        constexpr double largest_ratio = 2.0;
        return r_1() < largest_ratio;
    }
    [[nodiscard]] std::string text() const {
        return is_fitted() ? fmt::format("as {} milling the forces scatter by {:.1f} % with r_1 = {:.3f}",
                                         name_of(side), 100.0 * scatter(), r_1())
                           : fmt::format("as {} milling there is no fit", name_of(side));
    }
};

bool any_finite(const std::vector<CutRow>& cuts, double CutRow::*force) {
    return std::any_of(cuts.begin(), cuts.end(), [=](const CutRow& row) { return std::isfinite(row.*force); });
}

/// Of the readings with one column's sign turned: the possible one that fits best. `asked` unknown: on either side.
std::optional<Reading> best_turned(const std::vector<CutRow>& cuts, CutSide asked, const FitOnSide& fit) {
    std::optional<Reading> best;
    const auto try_turned = [&](std::string_view column, double CutRow::*force) {
        if (!any_finite(cuts, force)) {
            return;
        }
        std::vector<CutRow> turned = cuts;
        for (CutRow& row : turned) {
            row.*force = -(row.*force);
        }
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            if (asked != CutSide::unknown && side != asked) {
                continue;
            }
            const Reading reading{side, column, fit(turned, side)};
            const bool counts = reading.is_possible() && reading.has_usual_ratio();
            if (counts && (!best || reading.scatter() < best->scatter())) {
                best = reading;
            }
        }
    };
    try_turned("normal_force_N", &CutRow::normal_force_N);
    try_turned("feed_force_N", &CutRow::feed_force_N);
    return best;
}

std::string_view expected_sign(std::string_view column) {
    return column == "normal_force_N"
               ? "expected the positive sign where the force pushes tool and wall apart: always in down milling"
               : "expected the force on the workpiece, positive along the feed";
}

/// Of two possible readings: the one that fits far better, or alone has a usual force ratio.
const Reading* clearer(const Reading& one, const Reading& other) {
    constexpr double clear_ratio = 1.5;
    constexpr double exact = 0.005;  // scatters below it are alike
    const auto is_clearer = [&](const Reading& a, const Reading& b) {
        const double ratio = std::max(b.scatter(), exact) / std::max(a.scatter(), exact);
        return ratio > clear_ratio || (ratio * clear_ratio > 1.0 && a.has_usual_ratio() && !b.has_usual_ratio());
    };
    return is_clearer(one, other) ? &one : (is_clearer(other, one) ? &other : nullptr);
}

/// `chosen`: what the forces say as they are; empty where neither side is possible.
void refuse_turned_sign(const std::string& file, const std::optional<Reading>& chosen,
                        const std::optional<Reading>& turned) {
    constexpr double far_better = 0.5;
    constexpr double good_scatter = 0.05;
    const auto fits_far_better = [&] {
        return chosen->scatter() > good_scatter && turned->scatter() < far_better * chosen->scatter();
    };
    const auto alone_is_usual = [&] { return !chosen->has_usual_ratio() && clearer(*chosen, *turned) == &*turned; };
    const bool is_better = turned && (!chosen || fits_far_better() || alone_is_usual());
    if (is_better) {
        throw InputError(
            fmt::format("{}: column '{}': the sign is opposite to the convention: with it turned the forces "
                        "fit {} milling (scatter {:.1f} %, r_1 = {:.3f}); {}",
                        file, turned->turned_column, name_of(turned->side), 100.0 * turned->scatter(), turned->r_1(),
                        expected_sign(turned->turned_column)));
    }
}

/// At one width the opposite sign on another side, or with another force ratio, may fit as well.
void warn_of_other_sign(std::ostream& out, const Reading& chosen, const std::optional<Reading>& turned) {
    if (turned && clearer(chosen, *turned) != &chosen) {
        out << fmt::format(
            "warning: with the opposite sign of {} the forces fit {} milling as well (r_1 = {:.3f}): only cuts at "
            "other widths can decide\n",
            turned->turned_column, name_of(turned->side), turned->r_1());
    }
}

std::string why_not(const Reading& other) {
    const auto side = name_of(other.side);
    if (!other.is_fitted()) {
        return fmt::format("{} milling does not fit", side);
    }
    return other.r_1() > 0.0 ? fmt::format("as {} milling they scatter by {:.1f} %", side, 100.0 * other.scatter())
                             : fmt::format("{} milling would need an edge that pulls", side);
}

}  // namespace

double plane_scatter(const CuttingFit& fit) {
    const double cuts = fit.feed.cuts + fit.normal.cuts;
    return cuts > 0.0 ? std::sqrt((fit.feed.cuts * fit.feed.robust_sd * fit.feed.robust_sd +
                                   fit.normal.cuts * fit.normal.robust_sd * fit.normal.robust_sd) /
                                  cuts)
                      : 0.0;
}

CutSide side_that_fits(const CutsInWords& words, const std::vector<CutRow>& cuts, CutSide asked, const FitOnSide& fit,
                       std::ostream& out) {
    const std::string& file = words.file;
    const Reading down{CutSide::down, {}, fit(cuts, CutSide::down)};
    const Reading up{CutSide::up, {}, fit(cuts, CutSide::up)};
    const Reading* chosen = nullptr;
    if (down.is_possible() && up.is_possible()) {
        chosen = clearer(down, up);
    } else if (down.is_possible() || up.is_possible()) {
        chosen = down.is_possible() ? &down : &up;
    }
    const bool fits_any = down.is_possible() || up.is_possible();
    const Reading& stated = asked == CutSide::up ? up : down;
    const auto turned = best_turned(cuts, asked, fit);
    if (asked != CutSide::unknown && !stated.is_possible()) {
        refuse_turned_sign(file, std::nullopt, turned);
    } else if (!fits_any || chosen != nullptr) {
        refuse_turned_sign(file, chosen != nullptr ? std::optional(*chosen) : std::nullopt, turned);
    }
    if (!down.is_fitted() && !up.is_fitted()) {
        throw InputError(fmt::format("{}: {}", file, words.lack));
    }
    if (!fits_any) {
        throw InputError(
            fmt::format("{}: the cuts fit neither side: {}, {}; expected less than {:.0f} % and r_1 above 0, "
                        "from cuts of one tool and material on one side",
                        file, down.text(), up.text(), 100.0 * largest_scatter));
    }
    if (asked != CutSide::unknown) {
        if (!stated.is_possible() || (chosen != nullptr && chosen != &stated)) {
            throw InputError(fmt::format("{}: --side {}: {}, {}; expected the side of the cuts", file, name_of(asked),
                                         down.text(), up.text()));
        }
        warn_of_other_sign(out, stated, turned);
        return asked;
    }
    if (chosen == nullptr) {
        throw InputError(
            fmt::format("{}: the forces do not show the side of the cuts: {}, {}; expected --side down or "
                        "up, or cuts at several widths",
                        file, down.text(), up.text()));
    }
    const Reading& other = chosen == &down ? up : down;
    out << fmt::format("cut side: r_1 = {:.3f} ± {:.3f} at {:.4f} mm: {} milling ({})\n", chosen->r_1(),
                       chosen->fit.standard_error(estimation::cutting_r_1), chosen->fit.reference_chip_thickness_mm,
                       name_of(chosen->side), why_not(other));
    warn_of_other_sign(out, *chosen, turned);
    return chosen->side;
}

}  // namespace millforce::host
