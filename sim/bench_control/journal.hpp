// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "bench_control/contenders.hpp"

/// All runs of a benchmark as a CSV file that grows by a line with each run, so that an interrupted benchmark goes on
/// where it stood:
///
///     # millforce bench control 1
///     # settings 5f3a09c1
///     part,controller,seed,time_s,cutting_time_s,peak_over_limit,revolutions_over,teeth_broken,rubbing_s,finished
///     pocket_6,ours,1,14.2,12.9,0.93,0,0,0.4,1
///
/// The settings' checksum covers the program and all that the runs depend on beside part, controller and seed: runs of
/// two versions are never mixed.

namespace millforce::sim {

class Journal {
  public:
    /// Opens the file or begins it. A last line without its end, of a run that was interrupted while it was written, is
    /// cut off. Throws InputError: not writable, no journal, one with other settings.
    Journal(const std::filesystem::path& file, std::uint32_t settings);

    [[nodiscard]] bool has(std::string_view part, std::string_view controller, std::uint64_t seed) const;
    /// Writes a line and hands it to the operating system. From any thread.
    void add(const BenchRun& run);
    /// In the order of part, controller and seed. Not while runs are added.
    [[nodiscard]] std::vector<BenchRun> runs() const;
    /// Writes the file again in that order, so that the same benchmark gives the same bytes.
    void sort_file() const;

  private:
    using Key = std::tuple<std::string, std::string, std::uint64_t>;

    std::filesystem::path file_;
    std::uint32_t settings_;
    std::ofstream out_;
    std::mutex mutex_;
    std::set<Key> known_;
    std::vector<BenchRun> runs_;
};

/// Of a journal's runs. Throws InputError as Journal does.
[[nodiscard]] std::vector<BenchRun> read_runs(const std::filesystem::path& file, std::uint32_t settings);

}  // namespace millforce::sim
