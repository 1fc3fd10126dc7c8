// SPDX-License-Identifier: Apache-2.0
// Drilling cycles: one hole for each block, as plunges.
#include <algorithm>

#include "cnc/gcode_interpreter.hpp"

namespace millforce::sim::gcode {

/// One hole at the block's X and Y. Z, R, Q and P stay until G80.
void Interpreter::run_cycle(const SortedBlock& block) {
    const GcodeWord* word = block.first_of("XYZR");
    if (const GcodeWord* stray = block.first_of("IJ")) {
        fail(*stray, "I, J with an arc (G2, G3) only");
    }
    if (const GcodeWord* repeats = block.address('L'); repeats != nullptr && repeats->value != 1.0) {
        fail(*repeats, "L1: one hole for each block");
    }
    if (word == nullptr) {
        return;
    }
    take_cycle_levels(block);
    if (!has_bottom_ || !has_retract_) {
        fail(*word, "Z and R with the first hole of a cycle");
    }
    if (!(cycle_->bottom_mm < cycle_->retract_mm)) {
        fail(*word, "R above Z");
    }
    if ((cycle_->code == 83 || cycle_->code == 73) && !(cycle_->peck_mm > 0.0)) {
        fail(*word, "a peck Q above 0 with G73 and G83");
    }
    require_cutting_conditions(*word);
    drill(block, *word);
}

void Interpreter::take_cycle_levels(const SortedBlock& block) {
    const double from_mm = relative_ ? position_mm_.z() : 0.0;
    if (const GcodeWord* word = block.address('R')) {
        cycle_->retract_mm = from_mm + offset_mm(word);
        has_retract_ = true;
    }
    if (const GcodeWord* word = block.address('Z')) {
        cycle_->bottom_mm = (relative_ ? cycle_->retract_mm : 0.0) + offset_mm(word);
        has_bottom_ = true;
    }
    if (const GcodeWord* word = block.address('Q')) {
        cycle_->peck_mm = offset_mm(word);
    }
    if (const GcodeWord* word = block.address('P'); word != nullptr && block.code(dwell) == nullptr) {
        if (!(word->value >= 0.0 && word->value <= longest_dwell_s)) {
            fail(*word, "a dwell from 0 to 3600 s");
        }
        cycle_->dwell_s = word->value;
    }
    cycle_->clear_mm = returns_to_retract_ ? cycle_->retract_mm : std::max(cycle_->retract_mm, height_before_cycle_mm_);
}

void Interpreter::drill(const SortedBlock& block, const GcodeWord& subject) {
    Eigen::Vector3d above = target(block);
    above.z() = std::max(position_mm_.z(), cycle_->retract_mm);
    go(MoveKind::rapid, {position_mm_.x(), position_mm_.y(), above.z()}, subject);
    go(MoveKind::rapid, above, subject);
    go(MoveKind::rapid, {above.x(), above.y(), cycle_->retract_mm}, subject);
    for (const DrillingCycle::Step& step : cycle_->steps()) {
        if (step.kind == MoveKind::dwell) {
            Move move = next_move(MoveKind::dwell, position_mm_);
            move.dwell_s = step.dwell_s;
            append(move, subject);
        } else {
            go(step.kind, {above.x(), above.y(), step.z_mm}, subject);
        }
    }
}

void Interpreter::go(MoveKind kind, const Eigen::Vector3d& target_mm, const GcodeWord& subject) {
    Move move = next_move(kind, target_mm);
    if (kind != MoveKind::rapid) {
        move.feed_mm_s = feed_mm_s_;
        has_cut_ = true;
    }
    position_mm_ = target_mm;
    if (length_mm(move) > 0.0) {
        append(move, subject);
    }
}

}  // namespace millforce::sim::gcode
