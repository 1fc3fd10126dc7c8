// SPDX-License-Identifier: Apache-2.0
// The modal state that a block sets before it moves.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "cnc/gcode_interpreter.hpp"
#include "cutting/angle_units.hpp"

namespace millforce::sim::gcode {

namespace {}  // namespace

void Interpreter::run(const GcodeBlock& block) {
    line_ = block.line;
    if (block.is_percent) {
        ended_ = percent_seen_ || block_seen_;
        percent_seen_ = true;
        return;
    }
    if (block.words.empty()) {
        return;
    }
    block_seen_ = true;
    if (is_program_number(block)) {
        return;
    }
    const SortedBlock sorted = sort_words(block, file_name_);
    set_modes(sorted);
    follow_tool(sorted);
    run_dwell(sorted);
    if (sorted.code(retreat) != nullptr) {
        run_retreat(sorted);
    } else if (cycle_.has_value()) {
        run_cycle(sorted);
    } else {
        run_motion(sorted);
    }
    ended_ = sorted.code(stopping) != nullptr;
}

void Interpreter::fail(const GcodeWord& word, std::string_view expected) const {
    reject({file_name_, line_, word.column}, word.text, expected);
}

/// Once for each, with the line of the first.
void Interpreter::note(std::string_view what) {
    const auto is_same = [&](const std::string& told) { return told.ends_with(what); };
    if (std::none_of(notes_.begin(), notes_.end(), is_same)) {
        notes_.push_back(fmt::format("{}:{}: {}", file_name_, line_, what));
    }
}

/// O1001 alone: the number of a program.
bool Interpreter::is_program_number(const GcodeBlock& block) const {
    const GcodeWord& first = block.words.front();
    if (first.letter != 'O') {
        return false;
    }
    if (block.words.size() > 1) {
        fail(first, "a program without O-words: let the CAM system post it whole");
    }
    return true;
}

void Interpreter::set_modes(const SortedBlock& block) {
    if (const GcodeWord* word = block.code(units)) {
        mm_per_unit_ = tenths(*word) == 200 ? mm_per_inch : 1.0;
    }
    if (const GcodeWord* word = block.code(distance)) {
        relative_ = tenths(*word) == 910;
    }
    if (const GcodeWord* word = block.address('F')) {
        const double feed_mm_min = word->value * mm_per_unit_;
        if (!(feed_mm_min > 0.0 && feed_mm_min <= largest_feed_mm_min)) {
            fail(*word, fmt::format("a feed above 0 and at most {} mm/min", largest_feed_mm_min));
        }
        feed_mm_s_ = feed_mm_min / 60.0;
    }
    if (const GcodeWord* word = block.address('S')) {
        if (!(word->value >= 0.0 && word->value <= largest_spindle_speed_rpm)) {
            fail(*word, "a spindle speed from 0 to 1000000 rev/min");
        }
        spindle_speed_rad_s_ = word->value * rad_s_per_rpm;
    }
    if (const GcodeWord* word = block.code(spindle)) {
        spindle_on_ = word->value == 3.0;
    }
    if (const GcodeWord* word = block.code(return_level)) {
        returns_to_retract_ = tenths(*word) == 990;
    }
    if (const GcodeWord* word = block.code(plane)) {
        plane_ = tenths(*word) == 170 ? ArcPlane::xy : tenths(*word) == 180 ? ArcPlane::zx : ArcPlane::yz;
    }
    if (const GcodeWord* word = block.code(coordinate_system)) {
        choose_coordinates(*word);
    }
    if (block.code(coolant) != nullptr) {
        note("M7, M8, M9: coolant is not simulated");
    }
    if (block.code(pause) != nullptr) {
        note("M0, M1: the program goes on at once");
    }
    if (const GcodeWord* word = block.code(tool_length); word != nullptr && tenths(*word) == 430) {
        note("G43: coordinates are those of the tool's tip");
    }
    if (block.code(canned_cycle) != nullptr && cycle_.has_value()) {
        cycle_.reset();
        motion_.reset();
    }
    if (const GcodeWord* word = block.code(motion)) {
        set_motion(tenths(*word) / 10);
    }
}

void Interpreter::set_motion(long code) {
    constexpr std::array kinds{MoveKind::rapid, MoveKind::feed_line, MoveKind::arc_cw, MoveKind::arc_ccw};
    const bool is_line_or_arc = code < static_cast<long>(kinds.size());
    motion_ = is_line_or_arc ? std::optional(kinds[static_cast<std::size_t>(code)]) : std::nullopt;
    if (is_line_or_arc) {
        cycle_.reset();
        return;
    }
    if (!cycle_.has_value()) {
        height_before_cycle_mm_ = position_mm_.z();
        cycle_.emplace();
        has_bottom_ = false;
        has_retract_ = false;
    }
    cycle_->code = static_cast<int>(code);
}

/// One of G54 to G59, whichever the program uses: another one would lie elsewhere on the machine.
void Interpreter::choose_coordinates(const GcodeWord& word) {
    if (coordinates_ != 0 && coordinates_ != tenths(word)) {
        fail(word, fmt::format("G{}: one system of coordinates in a program", coordinates_ / 10));
    }
    coordinates_ = tenths(word);
}

void Interpreter::follow_tool(const SortedBlock& block) {
    if (const GcodeWord* word = block.address('T')) {
        if (!(word->value >= 0.0 && word->value <= largest_tool) || word->value != std::floor(word->value)) {
            fail(*word, "a tool number");
        }
        selected_tool_ = word->value;
    }
    const GcodeWord* change = block.code(tool_change);
    if (change == nullptr) {
        return;
    }
    if (!may_change_tool_ && has_cut_ && selected_tool_ != tool_) {
        fail(*change, fmt::format("no other tool than T{}: a scenario has one; split the program at the change (its "
                                  "maps: preview --tools)",
                                  tool_));
    }
    tool_ = selected_tool_;
    if (!may_change_tool_) {
        note("M6: the tool is the scenario's");
    }
}

}  // namespace millforce::sim::gcode
