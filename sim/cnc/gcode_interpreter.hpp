// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cnc/arc_plane.hpp"
#include "cnc/drilling_cycle.hpp"
#include "cnc/gcode.hpp"
#include "cnc/gcode_block.hpp"
#include "cnc/gcode_words.hpp"

namespace millforce::sim::gcode {

/// Runs a part program block by block: modal state in, moves out. What a block may do stands with what it does:
/// gcode_modes.cpp, gcode_moves.cpp (lines, arcs, dwell, retreat), gcode_cycles.cpp (drilling).
class Interpreter {
  public:
    Interpreter(std::string_view file_name, const GcodeSettings& settings)
        : file_name_(file_name),
          max_moves_(settings.max_moves),
          may_change_tool_(settings.may_change_tool),
          position_mm_(settings.start_mm),
          start_height_mm_(settings.start_mm.z()) {}

    void run(const GcodeBlock& block);

    bool ended() const { return ended_; }
    /// A file that began with % and is cut off before the closing one is no program.
    bool may_end_here() const { return block_seen_ && !percent_seen_; }
    void note_end() { note("the program ends with its file: no M2 or M30"); }
    std::vector<Move> take_moves() { return std::move(moves_); }
    std::vector<std::string> take_notes() { return std::move(notes_); }

  private:
    [[noreturn]] void fail(const GcodeWord& word, std::string_view expected) const;
    void note(std::string_view what);

    bool is_program_number(const GcodeBlock& block) const;
    void set_modes(const SortedBlock& block);
    void set_motion(long code);
    void choose_coordinates(const GcodeWord& word);
    void follow_tool(const SortedBlock& block);

    Move next_move(MoveKind kind, const Eigen::Vector3d& target_mm) const;
    Eigen::Vector3d target(const SortedBlock& block) const;
    double offset_mm(const GcodeWord* word) const;
    void append(const Move& move, const GcodeWord& subject);
    void require_cutting_conditions(const GcodeWord& subject) const;
    void run_motion(const SortedBlock& block);
    void set_centre(Move& move, const SortedBlock& block, const GcodeWord& subject) const;
    void set_centre_from_radius(Move& move, const GcodeWord& word) const;

    void check_other_use_of_p(const SortedBlock& block) const;
    void run_dwell(const SortedBlock& block);
    void run_retreat(const SortedBlock& block);

    void run_cycle(const SortedBlock& block);
    void take_cycle_levels(const SortedBlock& block);
    void drill(const SortedBlock& block, const GcodeWord& subject);
    void go(MoveKind kind, const Eigen::Vector3d& target_mm, const GcodeWord& subject);

    std::string_view file_name_;
    std::size_t max_moves_;
    bool may_change_tool_;
    std::vector<Move> moves_;
    std::vector<std::string> notes_;
    Eigen::Vector3d position_mm_;
    double start_height_mm_;
    std::optional<DrillingCycle> cycle_;
    double height_before_cycle_mm_ = 0.0;
    long coordinates_ = 0;  // in tenths; 0: not given
    double tool_ = 0.0;
    double selected_tool_ = 0.0;
    std::size_t line_ = 0;
    double mm_per_unit_ = 1.0;
    double feed_mm_s_ = 0.0;
    double spindle_speed_rad_s_ = 0.0;
    std::optional<MoveKind> motion_;
    bool has_bottom_ = false;
    bool has_retract_ = false;
    bool returns_to_retract_ = false;
    ArcPlane plane_ = ArcPlane::xy;
    bool has_cut_ = false;
    bool relative_ = false;
    bool spindle_on_ = false;
    bool percent_seen_ = false;
    bool block_seen_ = false;
    bool ended_ = false;
};

}  // namespace millforce::sim::gcode
