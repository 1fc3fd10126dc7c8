// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "bench_control/bench_plots.hpp"
#include "bench_control/bench_table.hpp"
#include "report/page_origin.hpp"

namespace millforce::sim {

/// Writes bench.html and the plots as SVG files into the folder. Throws InputError.
void write_bench_page(const std::filesystem::path& folder, const std::vector<BenchRun>& runs,
                      const host::Facts& origin);

}  // namespace millforce::sim
