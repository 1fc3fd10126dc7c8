// SPDX-License-Identifier: Apache-2.0
#include "firmware_link/link_drives.hpp"

namespace millforce::firmware {

void LinkDrives::on_message(const local_link::SampleMessage& message) {
    sample_.time_us = message.time_us;
    sample_.spindle_count = message.spindle_count;
    sample_.spindle_index_count = message.spindle_index_count;
    sample_.spindle_index_number = message.spindle_index_number;
    sample_.present = message.present;
    sample_.spindle_current_A = message.spindle_current_A;
    sample_.axis_current_A = message.axis_current_A;
    sample_.axis_velocity_mm_s = message.axis_velocity_mm_s;
    has_sample_ = true;
    state_ = hal::SourceState::running;
}

bool LinkDrives::take_sample(hal::DriveSample& sample) {
    if (!has_sample_) {
        return false;
    }
    has_sample_ = false;
    sample = sample_;
    return true;
}

}  // namespace millforce::firmware
