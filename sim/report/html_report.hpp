#pragma once

#include <span>
#include <string>
#include <string_view>

#include "report/run_result.hpp"

namespace millforce::sim {

/// report.html: one self-contained page. Headline and figures are plain HTML and need no script; charts and top views
/// are drawn from the embedded data. The page asks the network for nothing, and its content security policy forbids it
/// to. The first run is the controlled one. `runs` must not be empty.
std::string report_html(const ScenarioInfo& info, std::span<const RunResult> runs);

/// Text as HTML: & < > " ' as entities, bytes that are not UTF-8 as U+FFFD.
std::string html_escaped(std::string_view text);

}  // namespace millforce::sim
