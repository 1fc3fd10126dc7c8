// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "reproduce/hwang_runs.hpp"

/// Table 1 of Hwang et al.: seventeen rows of conditions, each milled at immersions of 20–80 %.

namespace millforce::sim {

/// A row with one immersion per cut. The seventeenth, with the immersion varying along the part, is separate.
struct TableRow {
    const char* group = "";  ///< the figure that shows it
    BenchCut cut{};
};

inline constexpr std::array<double, 7> table_immersions{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};

[[nodiscard]] std::vector<TableRow> table_rows();

/// "200 rpm, Ø100, 3 inserts, 0.15 mm, 1.5 mm deep, SM45C"
[[nodiscard]] std::string describe(const BenchCut& cut);

/// The estimates of one cut: as many as its revolutions give.
struct TableCut {
    double immersion = 0.0;
    std::vector<ForceDropRun> runs;

    [[nodiscard]] int estimates() const;
    [[nodiscard]] double mean() const;                    ///< NaN without an estimate
    [[nodiscard]] double largest_relative_error() const;  ///< of any single estimate; NaN without one
};

using TableResult = std::vector<TableCut>;  ///< one per immersion

inline constexpr int revolutions_per_estimate = 4;
inline constexpr int estimates_per_cut = 5;

[[nodiscard]] TableResult mill_row(const FittedForceDropLaw& law, const TableRow& row, std::uint64_t seed);

}  // namespace millforce::sim
