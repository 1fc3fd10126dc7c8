// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench_control/contenders.hpp"

namespace millforce::sim {

struct BenchSettings {
    std::filesystem::path out;     ///< an existing folder
    std::filesystem::path traces;  ///< an existing folder for the trace of each new run; empty: none
    std::vector<BenchPart> parts;
    std::vector<const Contender*> contenders;
    std::uint64_t first_seed = 1;
    int seeds = 30;
    unsigned threads = 1;
    RuleSettings rules;
};

/// What is being done, and its share.
using BenchProgress = std::function<void(const std::string& what, double share)>;

/// Writes the parts' files into OUT/parts and works out what their runs need, on all threads. Parts are not taught yet.
[[nodiscard]] std::vector<PreparedPart> prepare_all(const BenchSettings& settings, const BenchProgress& progress);

/// All runs that OUT/runs.csv does not hold yet, in the order of seeds, so that an interrupted benchmark has a little
/// of everything. Returns those of the settings' parts, contenders and seeds. Throws InputError.
[[nodiscard]] std::vector<BenchRun> run_bench(const BenchSettings& settings, const BenchProgress& progress);

}  // namespace millforce::sim
