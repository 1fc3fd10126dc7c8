// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/drive_sample.hpp"
#include "local_link/messages.hpp"

namespace millforce::test {

/// What a CNC's bridge sends of a sample.
inline local_link::SampleMessage message_of(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    local_link::SampleMessage message;
    message.time_us = sample.time_us;
    message.spindle_count = sample.spindle_count;
    message.spindle_index_count = sample.spindle_index_count;
    message.spindle_index_number = sample.spindle_index_number;
    message.present = sample.present;
    message.rapid = program.rapid;
    message.feed_hold = program.feed_hold;
    message.spindle_current_A = sample.spindle_current_A;
    message.axis_current_A = sample.axis_current_A;
    message.axis_velocity_mm_s = sample.axis_velocity_mm_s;
    message.programmed_feed_mm_s = program.programmed_feed_mm_s;
    message.operator_limit = program.operator_override;
    message.line = program.line;
    message.distance_to_go_mm = program.distance_to_go_mm;
    return message;
}

}  // namespace millforce::test
