// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
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
    [[nodiscard]] double largest_relative_error() const;  ///< error of any single estimate; NaN without one
};

using TableResult = std::vector<TableCut>;  ///< one per immersion

inline constexpr int revolutions_per_estimate = 4;
inline constexpr int estimates_per_cut = 5;

[[nodiscard]] bool is_steel(const TableRow& row);

inline constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();

[[nodiscard]] double relative_error(double ours, double truth);

/// The mean over cuts of |mean estimate/truth − 1|; `immersion` 0: of all.
[[nodiscard]] double mean_error(const std::vector<TableResult>& results, double immersion);

/// Estimates, all runs, and how many estimates lie within two of their standard deviations.
struct ForceDropTally {
    int runs = 0;
    int estimates = 0;
    int covered = 0;
    double error_sum = 0.0;
    double largest_error = 0.0;

    void add(const ForceDropRun& run);
    [[nodiscard]] double share() const;       ///< share of runs with an estimate
    [[nodiscard]] double coverage() const;    ///< NaN without an estimate, as the next two
    [[nodiscard]] double mean_error() const;  ///< relative
    [[nodiscard]] double largest() const;
};
[[nodiscard]] ForceDropTally tally_of(const std::vector<TableResult>& results);

[[nodiscard]] TableResult mill_row(const FittedForceDropLaw& law, const TableRow& row, std::uint64_t seed);

}  // namespace millforce::sim
