// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/parameter_block.hpp"
#include "firmware/parameters.hpp"
#include "firmware/tick.hpp"
#include "hal/drive_sample.hpp"
#include "part_map/part_map.hpp"
#include "part_map/run_memory.hpp"

namespace millforce::host {

/// The part map that a run leaves behind: what the estimator saw along the program's path, every half millimetre. The
/// path is put together from what the CNC reports, line and distance to go; neither program nor stock is needed. By
/// which rules it becomes a map: memory_map.hpp.
///
/// With tools by number there is a map for each tool: along the path that it goes itself, as if the program had its
/// blocks alone.
///
/// If a program begins again, the longer of its last two runs is kept. take(): no heap, some 100 ns. map(): some 10 ms
/// for each metre. Memory: 20 MB, most of it not touched by a short program; a path beyond longest_mm is not known. Not
/// thread-safe.
class MapLearner {
  public:
    static constexpr double longest_mm = 131072.0;
    static constexpr std::size_t most_blocks = 100'000;
    static constexpr double default_stock_tolerance_mm = 0.5;

    explicit MapLearner(const firmware::Parameters<float>& parameters);
    /// By number. Until set_tool() nothing is learnt.
    MapLearner(const firmware::MachineParameters<float>& machine, const std::vector<firmware::NumberedTool>& tools);

    /// By how much a blank may lie off in x and in y.
    void set_stock_tolerance(double mm) { stock_tolerance_mm_ = mm; }
    /// Another tool is in the spindle, at rest; 0, or one that is not among them: nothing is learnt.
    void set_tool(std::uint32_t number);

    /// Between the tick's estimate and its answer, once for each sample.
    void take(const firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program);

    /// What was seen up to now; empty where the CNC reported no position.
    [[nodiscard]] PartMap map() const { return map(0); }
    /// Of the tool with this number.
    [[nodiscard]] PartMap map(std::uint32_t number) const;

  private:
    [[nodiscard]] std::size_t place_of(std::uint32_t number) const;
    [[nodiscard]] std::optional<double> follow(const hal::ProgramStatus& program);
    void begin_block(const hal::ProgramStatus& program);
    [[nodiscard]] bool begins_again(const hal::ProgramStatus& program) const;
    void begin_run();
    void add(RunMemory::Bin& bin, const firmware::ForceControlTick<float>& tick) const;
    static void add_air(RunMemory::Bin& bin, float hidden_N, float feed_mm_s);

    firmware::MachineParameters<float> machine_;
    std::vector<firmware::NumberedTool> tools_;  // without numbers the one tool as 0
    std::size_t tool_ = 0;                       // in the spindle; tools_.size(): none of them
    RunMemory run_;
    RunMemory longest_;  // of the runs before
    double stock_tolerance_mm_ = default_stock_tolerance_mm;
    double to_go_mm_ = 0.0;
    std::optional<double> last_middle_mm_;
};

/// In words: how long the path of a run's memory is, how much of it is not known, and where no cut is known, why.
[[nodiscard]] std::string about_memory(const PartMap& map);

}  // namespace millforce::host
