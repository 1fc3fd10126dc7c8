// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "report/run_result.hpp"

namespace millforce::sim {

/// Writes what `millforce simulate` leaves behind into a directory, which is created if need be: summary.json,
/// report.html, trace.csv (the first run, the controlled one) and trace_<controller>.csv for every other run. Each file
/// is written whole or not at all; files of that name are replaced. `runs` must not be empty.
///
/// Returns the files written. Throws InputError, one line, where the directory cannot be made or a file not be written.
std::vector<std::filesystem::path> write_report(const std::filesystem::path& directory, const ScenarioInfo& info,
                                                std::span<const RunResult> runs);

}  // namespace millforce::sim
