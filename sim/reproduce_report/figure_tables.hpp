// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// Figures that belong together.
struct FigureTable {
    std::string title;  ///< title of a long table: what its rows have in common: "Table 1"; else empty
    std::span<const Figure> figures;
    [[nodiscard]] bool is_long() const { return !title.empty(); }
};

/// Rows from which on equal rows are a long table: shown folded, summarised on a terminal.
inline constexpr std::size_t long_table_rows = 15;

/// Cuts the figures, in their order, into long tables – at least `long_table_rows` in a row whose names are alike up to
/// the first comma or colon – and what is between them.
[[nodiscard]] std::vector<FigureTable> figure_tables(std::span<const Figure> figures);

/// The figure's name without what the table's title says already.
[[nodiscard]] std::string name_in_table(const Figure& figure, const FigureTable& table);

/// How much of its bound a figure uses: above 1 it is broken; −1 for one that is only shown.
[[nodiscard]] double use_of_bound(const Figure& figure);

struct FigureCount {
    std::size_t all = 0;
    std::size_t judged = 0;
    std::size_t broken = 0;
};
[[nodiscard]] FigureCount count_figures(std::span<const Figure> figures);

/// "24 figures, 20 within their bound, 4 shown without one", "24 figures, 22 within their bound, 2 BROKEN".
[[nodiscard]] std::string verdict(const FigureCount& count, std::string_view counted = "figures");

/// A figure's value as printed: four digits, whole numbers in full, "–" if there is none.
[[nodiscard]] std::string value_text(double value);

}  // namespace millforce::sim
