// SPDX-License-Identifier: Apache-2.0
#include "faults/faulty_machine.hpp"

#include <algorithm>

namespace millforce::faults {

hal::FeedOverride FaultyMachine::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    dt_s_ = has_first_ ? 1e-6 * static_cast<double>(sample.time_us - last_us_) : 0.0;
    time_s_ += dt_s_;
    has_first_ = true;
    last_us_ = sample.time_us;
    if (time_s_ < settings_.begins_s) {
        before_ = sample;
        const hal::FeedOverride output = controller_.step(sample, program);
        judge(output);
        return output;
    }
    return step_with_fault(sample, program);
}

hal::FeedOverride FaultyMachine::step_with_fault(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    if (!reaction_.has_begun && settings_.on_path.begin) {
        settings_.on_path.begin();
    }
    reaction_.has_begun = true;
    const double since_s = time_s_ - settings_.begins_s;
    hal::DriveSample seen = sample;
    hal::ProgramStatus told = program;
    repair_where_held();
    if (settings_.corrupt && !reaction_.is_repaired) {
        settings_.corrupt(seen, told, before_, since_s);
    }
    const hal::FeedOverride output = controller_.step(seen, told);
    judge(output);
    if (!program.rapid) {
        judge_rise(output, since_s);
        judge_stop(output, told);
    }
    if (!reaction_.has_reacted && (output.hold || output.fault != 0)) {
        reaction_.has_reacted = true;
        reaction_.after_s = since_s;
        reaction_.found_by = output.fault;
    }
    return output;
}

void FaultyMachine::repair_where_held() {
    if (settings_.on_path.repair && is_over() && !reaction_.is_repaired) {
        settings_.on_path.repair();
        reaction_.is_repaired = true;
        resets_left_ = most_resets;
    } else if (waits_for_reset() || is_pressed_) {
        press_reset();
    }
}

void FaultyMachine::press_reset() {
    since_reset_s_ += dt_s_;
    const bool is_due = is_pressed_ ? since_reset_s_ > 0.5 * reset_after_s : since_reset_s_ > reset_after_s;
    if (!is_due) {
        return;
    }
    is_pressed_ = !is_pressed_;
    settings_.on_path.reset(is_pressed_);
    if (is_pressed_) {
        --resets_left_;
        since_reset_s_ = 0.0;
        reaction_.held_s = 0.0;
    } else if (reaction_.fault == 0) {
        resets_left_ = 0;
    }
}

void FaultyMachine::judge(const hal::FeedOverride& output) {
    constexpr double rounding = 1e-3;  // of an override in a frame
    const auto ratio = static_cast<double>(output.ratio);
    const bool is_within = ratio >= 0.0 && ratio <= settings_.override_max + rounding;
    reaction_.is_beyond_bound = reaction_.is_beyond_bound || !is_within;
    reaction_.ran_in_fault = reaction_.ran_in_fault || (output.fault != 0 && !output.hold);
    reaction_.fault = output.fault;
    reaction_.held_s = output.hold ? reaction_.held_s + dt_s_ : 0.0;
}

void FaultyMachine::judge_stop(const hal::FeedOverride& output, const hal::ProgramStatus& told) {
    constexpr float standing = 0.01F;
    constexpr double too_long_s = 1.0;
    const bool is_operators = !(told.operator_override >= standing);
    const bool is_silent = output.ratio < standing && !output.hold && output.fault == 0 && !is_operators;
    stopped_s_ = is_silent ? stopped_s_ + dt_s_ : 0.0;
    reaction_.stopped_silently = reaction_.stopped_silently || stopped_s_ > too_long_s;
}

void FaultyMachine::judge_rise(const hal::FeedOverride& output, double since_s) {
    constexpr double tolerance = 0.01;
    if (!settings_.leaves_blind || reaction_.is_repaired || output.hold || since_s < detection_s) {
        return;
    }
    const auto ratio = static_cast<double>(output.ratio);
    reaction_.rose_blind = reaction_.rose_blind || (blind_ratio_ >= 0.0 && ratio > blind_ratio_ + tolerance);
    blind_ratio_ = blind_ratio_ < 0.0 ? ratio : std::min(blind_ratio_, ratio);
}

}  // namespace millforce::faults
