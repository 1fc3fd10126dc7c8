// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "report/run_result.hpp"

namespace millforce::sim {

/// report.html: one self-contained page. Headline and figures are plain HTML and need no script; charts and top views
/// are drawn from the embedded data. The page asks the network for nothing, and its content security policy forbids it
/// to. The first run is the controlled one. `runs` must not be empty.
std::string report_html(const ScenarioInfo& info, std::span<const RunResult> runs);

}  // namespace millforce::sim
