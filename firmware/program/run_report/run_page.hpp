// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/page_origin.hpp"
#include "run_report/run_history.hpp"

namespace millforce::host {

/// Where a run's data come from, as its page states it.
struct RunOrigin {
    std::string title;             ///< e.g. "Run on can0"
    bool is_replay = false;        ///< the override did not act
    bool is_monitor_only = false;  ///< the tool's file leaves the override to the operator
    Facts facts{};                 ///< machine, tool, versions, command, dates
};

/// report.html of a run: one page that asks the network for nothing. Words and tables are plain HTML and need no
/// script. It shows what was measured and estimated, and no more.
[[nodiscard]] std::string run_page_html(const RunHistory& history, const RunOrigin& origin);

/// What run_page.js draws: all bins, two values (lowest, highest) or one for each. null: no value. Forces to 0.1 N,
/// ratios to 0.001, depths to 0.001 mm.
[[nodiscard]] std::string run_page_json(const RunHistory& history);

}  // namespace millforce::host
