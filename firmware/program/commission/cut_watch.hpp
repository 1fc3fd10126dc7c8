// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "commission/revolution_blocks.hpp"
#include "commission/samples.hpp"

namespace millforce::host {

/// One pass of a program of standard cuts: in air first, then along the workpiece.
struct CutPass {
    double feed_mm_min = 0.0;
    double axial_depth_mm = 0.0;
    double radial_width_mm = 0.0;
};

struct CutWatchSettings {
    std::uint32_t counts_per_rev = 0;
    std::size_t axis = 0;  ///< that feeds: 0 x, 1 y, 2 z
    std::vector<CutPass> passes;
    double tool_diameter_mm = 0.0;
    int flutes = 0;
    double travel_per_motor_turn_mm = 0.0;  ///< stretches are whole turns, so that the screw's ripple averages out
    double smallest_rise_A = 0.0;           ///< of the spindle's current from air to the lightest pass, by data sheets
};

/// A stretch for the table of cuts; depth and width 0: in air.
struct FoundStretch {
    double start_s = 0.0;
    double end_s = 0.0;
    double axial_depth_mm = 0.0;
    double radial_width_mm = 0.0;
};

/// Finds the passes of a program of standard cuts in the samples: by their feeds, in their order, and by the spindle's
/// current, which rises where the tool meets the workpiece. A feed that the program does not have is left out.
class CutWatch final : public StepWatch {
  public:
    explicit CutWatch(const CutWatchSettings& settings);

    void add(const TimedSample& timed) override;
    void end() override;
    [[nodiscard]] bool is_enough() const override { return next_ == settings_.passes.size(); }
    [[nodiscard]] std::string lacks() const override;

    /// Air and cut of each pass found so far.
    [[nodiscard]] const std::vector<FoundStretch>& stretches() const { return stretches_; }
    /// For read_recorded_cuts(). `recording`: the file that holds the samples.
    void write_table(const std::filesystem::path& table, const std::filesystem::path& recording) const;

  private:
    /// Neighbouring blocks at one feed, all in air or all in cut.
    struct Part {
        bool in_cut = false;
        double start_s = 0.0;
        double end_s = 0.0;
        double current_A = 0.0;
        double feed_mm_s = 0.0;
        long blocks = 0;
    };
    void take_block(const RevolutionBlock& block);
    void begin_part(const RevolutionBlock& block, bool in_cut);
    void end_part();
    void use(const Part& part);
    [[nodiscard]] bool is_in_run(const RevolutionBlock& block) const;
    /// The middle of a part, in whole turns of the screw; empty (start = end) where it is too short.
    [[nodiscard]] FoundStretch middle_of(const Part& part, const CutPass& pass) const;

    CutWatchSettings settings_;
    RevolutionBlocks blocks_;
    Part part_{};
    bool has_part_ = false;
    double speed_rad_s_ = 0.0;
    double air_A_ = 0.0;  ///< newest idle current
    bool knows_air_ = false;
    std::size_t next_ = 0;  ///< pass that is expected
    FoundStretch pending_air_{};
    std::vector<FoundStretch> stretches_;
};

}  // namespace millforce::host
