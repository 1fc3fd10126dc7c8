// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "report/run_result.hpp"

/// The figures of the runs side by side: for a program (JSON), for a terminal, for the report.

namespace millforce::sim {

/// The runs of constant feeds: the largest that is safe everywhere, even where the material is harder, and the largest
/// that is safe for exactly this material, which is known only in hindsight.
inline constexpr const char* constant_feed = "constant";
inline constexpr const char* constant_feed_in_hindsight = "constant_hindsight";

/// Time saved in % against a run of a constant feed: 100 (T_constant − T) / T_constant. No value for a constant feed
/// itself, if the other is missing, or if one of the two did not reach the end of the part program: a run that stops
/// early has saved nothing.
std::optional<double> time_saved_percent(const RunResult& run, std::span<const RunResult> runs,
                                         std::string_view against = constant_feed);

/// The run of that name, nullptr if there is none.
const RunResult* run_named(std::string_view name, std::span<const RunResult> runs);

/// One figure of every run, ready to print. A cell without a value is "-". ASCII only.
struct FigureRow {
    std::string label;
    std::string explanation;  ///< one sentence: what the figure is
    std::vector<std::string> cells;
};

std::vector<FigureRow> figure_rows(std::span<const RunResult> runs);

/// The table for the terminal: figures down, controllers across, aligned with blanks, at most 100 columns wide; more
/// controllers than fit go into further blocks below. Ends with a line break. Empty for no runs.
std::string summary_table(const ScenarioInfo& info, std::span<const RunResult> runs);

/// summary.json: `scenario` and `runs`, keys as in ScenarioInfo and RunFigures plus `time_saved_percent` and
/// `time_saved_in_hindsight_percent`. A missing value is null.
std::string summary_json(const ScenarioInfo& info, std::span<const RunResult> runs);

}  // namespace millforce::sim
