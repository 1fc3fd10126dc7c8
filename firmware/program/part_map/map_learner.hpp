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
/// path is put together from what the CNC reports, line and distance to go; neither program nor stock is needed.
///
/// A place where the force was that of air is air, as long as a cut that the noise may have hidden there would not load
/// a tooth up to its limit at the feed of air; else it is not known. Where immersion and depth were estimated they are
/// the cut, with their deviations. Where there was a force without them, as while the tool enters or leaves, the cut is
/// at most that of its neighbour, or a slot as deep where the force was higher than that; otherwise it is not known.
/// Nor are places that the run did not reach. A cut that seems less than 0.6 as deep as another one of its block within
/// two diameters is at most that one: the forces over a hole are those of a wide and shallow cut. So is air within
/// twice the stock's tolerance of a cut: where this blank had air, the next one may have stock.
///
/// Depth and K_s enter the forces as a product: the depth is the one that gives the measured force by the tool's law.
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
