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

hal::FeedOverride FaultyMachine::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const double dt_s = has_first_ ? 1e-6 * static_cast<double>(sample.time_us - last_us_) : 0.0;
    has_first_ = true;
    last_us_ = sample.time_us;
    time_s_ += dt_s;
    if (time_s_ < settings_.begins_s) {
        before_ = sample;
        return controller_.step(sample, program);
    }
    since_s_ = time_s_ - settings_.begins_s;
    hal::DriveSample seen = sample;
    hal::ProgramStatus told = program;
    corrupt(seen, told);
    const hal::FeedOverride output = controller_.step(seen, told);
    reaction_.has_begun = true;
    if (!reaction_.has_reacted && (output.hold || output.fault != 0)) {
        reaction_.has_reacted = true;
        reaction_.after_s = since_s_;
    }
    reaction_.fault = output.fault;
    return output;
}

void FaultyMachine::corrupt(hal::DriveSample& sample, hal::ProgramStatus& program) {
    corrupt_spindle(sample);
    corrupt_axes(sample);
    corrupt_encoder(sample);
    corrupt_program(program);
    corrupt_time(sample);
}

void FaultyMachine::corrupt_spindle(hal::DriveSample& sample) {
    float& current_A = sample.spindle_current_A;
    switch (settings_.fault) {
        case SignalFault::spindle_weak:
            current_A *= 0.3F;
            break;
        case SignalFault::spindle_strong:
            current_A *= 3.0F;
            break;
        case SignalFault::spindle_saturated:
            current_A = std::min(current_A, before_.spindle_current_A);
            break;
        case SignalFault::spindle_drifts:
            current_A -= static_cast<float>(drift_A_per_s * since_s_);
            break;
        case SignalFault::spindle_frozen:
            current_A = before_.spindle_current_A;
            break;
        case SignalFault::spindle_dead:
            current_A = 0.0F;
            break;
        case SignalFault::spindle_reversed:
            current_A = -current_A;
            break;
        case SignalFault::spindle_noisy:
            current_A += static_cast<float>(std::normal_distribution(0.0, 0.1 * settings_.spindle_rated_A)(random_));
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

void FaultyMachine::corrupt_axes(hal::DriveSample& sample) {
    float& x_A = sample.axis_current_A[0];
    const auto scale_velocities = [&sample](float factor) {
        for (float& velocity : sample.axis_velocity_mm_s) {
            velocity *= factor;
        }
    };
    switch (settings_.fault) {
        case SignalFault::x_tenfold:
            x_A *= 10.0F;
            break;
        case SignalFault::x_reversed:
            x_A = -x_A;
            break;
        case SignalFault::x_drifts:
            x_A += static_cast<float>(drift_A_per_s * since_s_);
            break;
        case SignalFault::x_frozen:
            x_A = before_.axis_current_A[0];
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

void FaultyMachine::corrupt_encoder(hal::DriveSample& sample) {
    const std::uint32_t turned = sample.spindle_count - before_.spindle_count;
    const std::uint32_t index_turned = sample.spindle_index_count - before_.spindle_count;
    switch (settings_.fault) {
        case SignalFault::encoder_double:
            sample.spindle_count = before_.spindle_count + 2U * turned;
            sample.spindle_index_count = before_.spindle_count + 2U * index_turned;
            break;
        case SignalFault::encoder_half:
            sample.spindle_count = before_.spindle_count + turned / 2U;
            sample.spindle_index_count =
                before_.spindle_count + static_cast<std::uint32_t>(static_cast<std::int32_t>(index_turned) / 2);
            break;
        case SignalFault::encoder_frozen:
            sample.spindle_count = before_.spindle_count;
            sample.spindle_index_count = before_.spindle_index_count;
            sample.spindle_index_number = before_.spindle_index_number;
            break;
        case SignalFault::encoder_absent:
            make_absent(sample, hal::Present::spindle_count);
            break;
        default:
            break;
    }
}

void FaultyMachine::corrupt_program(hal::ProgramStatus& program) {
    switch (settings_.fault) {
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

void FaultyMachine::corrupt_time(hal::DriveSample& sample) {
    if (settings_.fault == SignalFault::time_frozen) {
        sample.time_us = before_.time_us;
    } else if (settings_.fault == SignalFault::time_backwards) {
        sample.time_us = before_.time_us - (sample.time_us - before_.time_us);
    }
}

}  // namespace millforce::faults
