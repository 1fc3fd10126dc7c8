// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/parameters.hpp"
#include "firmware/tick.hpp"
#include "hal/drive_sample.hpp"
#include "part_map/part_map.hpp"

namespace millforce::host {

/// The part map that a run leaves behind: what the estimator saw along the program's path, every half millimetre. The
/// path is put together from what the CNC reports, line and distance to go; neither program nor stock is needed.
///
/// A place where the force was that of air is air. Where immersion and depth were estimated they are the cut, with
/// their deviations. Where there was a force without them, as while the tool enters or leaves, the cut is at most that
/// of its neighbour, or a slot as deep where the force was higher than that; otherwise it is not known. Nor are places
/// that the run did not reach.
///
/// Depth and K_s enter the forces as a product: the depth is the one that gives the measured force by the tool's law.
///
/// If a program begins again, the longer of its last two runs is kept. take(): no heap, some 100 ns. map(): some 10 ms
/// for each metre. Memory: 20 MB, most of it not touched by a short program; a path beyond longest_mm is not known. Not
/// thread-safe.
class MapLearner {
  public:
    static constexpr double bin_mm = 0.5;
    static constexpr double longest_mm = 131072.0;
    static constexpr std::size_t most_blocks = 100'000;

    explicit MapLearner(const firmware::Parameters<float>& parameters);

    /// Between the tick's estimate and its answer, once for each sample.
    void take(const firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program);

    /// What was seen up to now; empty where the CNC reported no position.
    [[nodiscard]] PartMap map() const;

  private:
    struct Block {
        std::uint32_t line = 0;
        bool rapid = false;
        double begin_mm = 0.0;
        double end_mm = 0.0;
        float feed_mm_s = 0.0F;
        float spindle_speed_rad_s = 0.0F;
    };
    /// Sums over the estimates that belong to a piece of the path.
    struct Bin {
        std::uint16_t air = 0;
        std::uint16_t contact = 0;  ///< of them with an engagement: cut
        std::uint16_t cut = 0;
        std::uint16_t up = 0;  ///< of the cuts in up milling
        float immersion = 0.0F;
        float immersion_variance = 0.0F;
        float depth_mm = 0.0F;
        float depth_variance_mm2 = 0.0F;
        float highest_N = 0.0F;  ///< F_at in contact, and the feed there
        float feed_per_tooth_mm = 0.0F;
    };
    struct Run {
        std::vector<Block> blocks;
        std::vector<Bin> bins;
        std::size_t used = 0;  // bins
        double path_mm = 0.0;  // farthest
    };

    [[nodiscard]] std::optional<double> follow(const hal::ProgramStatus& program);
    void begin_block(const hal::ProgramStatus& program);
    [[nodiscard]] bool begins_again(const hal::ProgramStatus& program) const;
    void begin_run();
    void add(Bin& bin, const firmware::ForceControlTick<float>& tick) const;
    [[nodiscard]] PartMap map_of(const Run& run) const;
    [[nodiscard]] std::vector<MapPlace> seen_in(const Run& run) const;
    [[nodiscard]] MapPlace seen_in(const Bin& bin) const;
    [[nodiscard]] bool carries(const std::vector<EngagedArc>& cut, const Bin& bin) const;
    void bound_by(const std::vector<MapPlace>& seen, std::size_t k, const Bin& bin, MapPlace& place) const;

    firmware::Parameters<float> parameters_;
    Run run_;
    Run longest_;  // of the runs before
    double to_go_mm_ = 0.0;
    std::optional<double> last_middle_mm_;
};

/// In words: how long the path of a run's memory is, how much of it is not known, and where no cut is known, why.
[[nodiscard]] std::string about_memory(const PartMap& map);

}  // namespace millforce::host
