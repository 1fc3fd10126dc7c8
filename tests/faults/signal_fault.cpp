// SPDX-License-Identifier: Apache-2.0
#include "faults/signal_fault.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace millforce::faults {

namespace {

constexpr double drift_A_per_s = 0.5;

void make_absent(hal::DriveSample& sample, hal::Present quantity) {
    sample.present = static_cast<std::uint8_t>(sample.present & ~hal::mask(quantity));
}

}  // namespace

const char* name_of(SignalFault fault) {
    constexpr const char* names[] = {"none",
                                     "spindle current × 0.3",
                                     "spindle current × 3",
                                     "spindle current saturated",
                                     "spindle current drifts, −0.5 A/s",
                                     "spindle current frozen",
                                     "spindle current 0",
                                     "spindle current reversed",
                                     "spindle current noisy, 10 %",
                                     "spindle current absent",
                                     "x current × 10",
                                     "x current reversed",
                                     "x current drifts, 0.5 A/s",
                                     "x current frozen",
                                     "x current 0",
                                     "x and y currents swapped",
                                     "velocities × 10⁶",
                                     "velocities × 0.1",
                                     "encoder counts twice",
                                     "encoder counts half",
                                     "encoder frozen",
                                     "encoder absent",
                                     "NaN",
                                     "rapid bit stuck",
                                     "F × 0.1",
                                     "F × 10",
                                     "time frozen",
                                     "time runs backwards"};
    static_assert(std::size(names) == signal_faults);
    return names[static_cast<std::size_t>(fault)];
}

void SignalCorruption::corrupt(hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before,
                               double since_s) {
    corrupt_spindle(sample, before, since_s);
    corrupt_axes(sample, before, since_s);
    corrupt_encoder(sample, before);
    corrupt_program(program);
    corrupt_time(sample, before);
}

void SignalCorruption::corrupt_spindle(hal::DriveSample& sample, const hal::DriveSample& before, double since_s) {
    float& current_A = sample.spindle_current_A;
    switch (fault_) {
        case SignalFault::spindle_weak:
            current_A *= 0.3F;
            break;
        case SignalFault::spindle_strong:
            current_A *= 3.0F;
            break;
        case SignalFault::spindle_saturated:
            current_A = std::min(current_A, before.spindle_current_A);
            break;
        case SignalFault::spindle_drifts:
            current_A -= static_cast<float>(drift_A_per_s * since_s);
            break;
        case SignalFault::spindle_frozen:
            current_A = before.spindle_current_A;
            break;
        case SignalFault::spindle_dead:
            current_A = 0.0F;
            break;
        case SignalFault::spindle_reversed:
            current_A = -current_A;
            break;
        case SignalFault::spindle_noisy:
            current_A += static_cast<float>(std::normal_distribution(0.0, 0.1 * spindle_rated_A_)(random_));
            break;
        case SignalFault::spindle_absent:
            make_absent(sample, hal::Present::spindle_current);
            break;
        case SignalFault::not_a_number:
            current_A = std::numeric_limits<float>::quiet_NaN();
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_axes(hal::DriveSample& sample, const hal::DriveSample& before, double since_s) const {
    float& x_A = sample.axis_current_A[0];
    const auto scale_velocities = [&sample](float factor) {
        for (float& velocity : sample.axis_velocity_mm_s) {
            velocity *= factor;
        }
    };
    switch (fault_) {
        case SignalFault::x_tenfold:
            x_A *= 10.0F;
            break;
        case SignalFault::x_reversed:
            x_A = -x_A;
            break;
        case SignalFault::x_drifts:
            x_A += static_cast<float>(drift_A_per_s * since_s);
            break;
        case SignalFault::x_frozen:
            x_A = before.axis_current_A[0];
            break;
        case SignalFault::x_dead:
            x_A = 0.0F;
            break;
        case SignalFault::x_and_y_swapped:
            std::swap(sample.axis_current_A[0], sample.axis_current_A[1]);
            break;
        case SignalFault::velocities_huge:
            scale_velocities(1e6F);
            break;
        case SignalFault::velocities_small:
            scale_velocities(0.1F);
            break;
        case SignalFault::not_a_number:
            sample.axis_current_A.fill(std::numeric_limits<float>::quiet_NaN());
            sample.axis_velocity_mm_s.fill(std::numeric_limits<float>::quiet_NaN());
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_encoder(hal::DriveSample& sample, const hal::DriveSample& before) const {
    const std::uint32_t turned = sample.spindle_count - before.spindle_count;
    const std::uint32_t index_turned = sample.spindle_index_count - before.spindle_count;
    switch (fault_) {
        case SignalFault::encoder_double:
            sample.spindle_count = before.spindle_count + 2U * turned;
            sample.spindle_index_count = before.spindle_count + 2U * index_turned;
            break;
        case SignalFault::encoder_half:
            sample.spindle_count = before.spindle_count + turned / 2U;
            sample.spindle_index_count =
                before.spindle_count + static_cast<std::uint32_t>(static_cast<std::int32_t>(index_turned) / 2);
            break;
        case SignalFault::encoder_frozen:
            sample.spindle_count = before.spindle_count;
            sample.spindle_index_count = before.spindle_index_count;
            sample.spindle_index_number = before.spindle_index_number;
            break;
        case SignalFault::encoder_absent:
            make_absent(sample, hal::Present::spindle_count);
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_program(hal::ProgramStatus& program) const {
    switch (fault_) {
        case SignalFault::rapid_stuck:
            program.rapid = true;
            break;
        case SignalFault::feed_told_low:
            program.programmed_feed_mm_s *= 0.1F;
            break;
        case SignalFault::feed_told_high:
            program.programmed_feed_mm_s *= 10.0F;
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_time(hal::DriveSample& sample, const hal::DriveSample& before) const {
    if (fault_ == SignalFault::time_frozen) {
        sample.time_us = before.time_us;
    } else if (fault_ == SignalFault::time_backwards) {
        sample.time_us = before.time_us - (sample.time_us - before.time_us);
    }
}

}  // namespace millforce::faults
