// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "report/run_result.hpp"

namespace millforce::sim {

/// Buckets per chart; two points of a series come from each (see decimation.hpp).
inline constexpr std::size_t chart_bucket_count = 1250;
/// Points of one run's path in the top view; longer traces are joined in groups that keep the group's largest force.
inline constexpr std::size_t top_view_point_count = 8000;

/// What report.js draws, as compact JSON that can be put inside a <script> element. Forces to 0.1 N, times to 1 ms,
/// lengths to 0.01 mm, ratios to 0.001; null is "no value". For a run of 5 minutes less than 1 MB.
///
/// - `scenario`: title, limit, cutter diameter, stock rectangle or null
/// - `runs`: name, and the path of the top view as differences of integers: t (ms), s, x, y, z (10 µm), share of the
///   tooth limit (‰; −1 rapid)
/// - `charts.time` and `charts.path`: length of the axis, bucket count, and per run the columns; in the first run's
///   also the moving limit, the estimates, their 95 % bands (estimate ± 1.96 sd), the states and limits (one
///   hexadecimal digit per bucket, see cut_state.hpp)
std::string report_data_json(const ScenarioInfo& info, std::span<const RunResult> runs);

}  // namespace millforce::sim
