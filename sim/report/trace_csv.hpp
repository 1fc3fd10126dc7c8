// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "report/run_result.hpp"

namespace millforce::sim {

/// A column of the trace: numbers, or text; the other one is null.
struct TraceColumn {
    const char* name;
    double (*number)(const TracePoint& point);
    const char* (*text)(const TracePoint& point);
};
/// Those of every table of estimates, and those that only a simulation knows; each in the order of the file.
std::span<const TraceColumn> estimate_columns();
std::span<const TraceColumn> simulation_columns();

/// The trace of a run as CSV, one line per point. The first columns are those of every file of estimates: time_s,
/// state, tangential_force_N, feed_force_N, radial_immersion, radial_immersion_sd, axial_depth_mm, axial_depth_sd_mm,
/// peak_force_N, force_limit_N, override. Then what only a simulation knows: controller, path and position, feed, limit
/// and fault by name, rapid (0 or 1), tooth_force_N, the truth in columns true_*, runout_um, cut_side by name and
/// law_misfit. An empty cell is "no estimate". Eight significant digits: a tenth of a millisecond in an hour, a tenth
/// of a micrometre in a metre.
std::string trace_csv(const RunResult& run);

/// Name of a run's trace among `runs`: trace.csv for the first, trace_<controller>.csv for the others. Characters
/// outside [A-Za-z0-9_-] become '_'.
std::string trace_file_name(const RunResult& run, std::span<const RunResult> runs);

}  // namespace millforce::sim
