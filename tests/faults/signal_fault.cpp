// SPDX-License-Identifier: Apache-2.0
#include "faults/signal_fault.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace millforce::faults {

namespace {

constexpr double drift_A_per_s = 0.5;
constexpr double offset_of_rated = 0.1;

float drifted_A(double since_s) {
    return static_cast<float>(drift_A_per_s * since_s);
}

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
                                     "spindle current drifts, 0.5 A/s",
                                     "spindle current −10 % of rated",
                                     "spindle current +10 % of rated",
                                     "spindle current frozen",
                                     "spindle current 0",
                                     "spindle current reversed",
                                     "spindle current noisy, 10 %",
                                     "spindle current absent",
                                     "x current × 10",
                                     "x current × 0.3",
                                     "x current reversed",
                                     "x current drifts, 0.5 A/s",
                                     "x current drifts, −0.5 A/s",
                                     "x current +10 % of rated",
                                     "x current frozen",
                                     "x current 0",
                                     "y current × 10",
                                     "y current × 0.3",
                                     "y current reversed",
                                     "y current drifts, 0.5 A/s",
                                     "y current frozen",
                                     "y current 0",
                                     "x and y currents swapped",
                                     "velocities × 10⁶",
                                     "velocities × 0.1",
                                     "velocities 0",
                                     "velocities frozen",
                                     "velocities reversed",
                                     "x and y velocities swapped",
                                     "encoder counts twice",
                                     "encoder counts half",
                                     "encoder loses 3 %",
                                     "encoder reversed",
                                     "index pulse lost",
                                     "encoder frozen",
                                     "encoder absent",
                                     "NaN",
                                     "rapid bit stuck",
                                     "F × 0.1",
                                     "F × 10",
                                     "F not a number",
                                     "operator's override × 3",
                                     "operator's override not a number",
                                     "feed hold stuck",
                                     "time frozen",
                                     "time runs backwards",
                                     "time runs twice as fast",
                                     "time runs half as fast"};
    static_assert(std::size(names) == signal_faults);
    return names[static_cast<std::size_t>(fault)];
}

void SignalCorruption::corrupt(hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before,
                               double since_s) {
    corrupt_spindle(sample, before, since_s);
    corrupt_axes(sample, before, since_s);
    corrupt_velocities(sample, before);
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
            current_A -= drifted_A(since_s);
            break;
        case SignalFault::spindle_drifts_up:
            current_A += drifted_A(since_s);
            break;
        case SignalFault::spindle_low:
            current_A -= static_cast<float>(offset_of_rated * spindle_rated_A_);
            break;
        case SignalFault::spindle_high:
            current_A += static_cast<float>(offset_of_rated * spindle_rated_A_);
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
    float& y_A = sample.axis_current_A[1];
    switch (fault_) {
        case SignalFault::x_tenfold:
            x_A *= 10.0F;
            break;
        case SignalFault::x_weak:
            x_A *= 0.3F;
            break;
        case SignalFault::x_reversed:
            x_A = -x_A;
            break;
        case SignalFault::x_drifts:
            x_A += drifted_A(since_s);
            break;
        case SignalFault::x_drifts_down:
            x_A -= drifted_A(since_s);
            break;
        case SignalFault::x_high:
            x_A += static_cast<float>(offset_of_rated * axis_rated_A_);
            break;
        case SignalFault::x_frozen:
            x_A = before.axis_current_A[0];
            break;
        case SignalFault::x_dead:
            x_A = 0.0F;
            break;
        case SignalFault::y_tenfold:
            y_A *= 10.0F;
            break;
        case SignalFault::y_weak:
            y_A *= 0.3F;
            break;
        case SignalFault::y_reversed:
            y_A = -y_A;
            break;
        case SignalFault::y_drifts:
            y_A += drifted_A(since_s);
            break;
        case SignalFault::y_frozen:
            y_A = before.axis_current_A[1];
            break;
        case SignalFault::y_dead:
            y_A = 0.0F;
            break;
        case SignalFault::x_and_y_swapped:
            std::swap(x_A, y_A);
            break;
        case SignalFault::not_a_number:
            sample.axis_current_A.fill(std::numeric_limits<float>::quiet_NaN());
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_velocities(hal::DriveSample& sample, const hal::DriveSample& before) const {
    auto& velocity_mm_s = sample.axis_velocity_mm_s;
    const auto scale = [&](float factor) {
        for (float& v_mm_s : velocity_mm_s) {
            v_mm_s *= factor;
        }
    };
    switch (fault_) {
        case SignalFault::velocities_huge:
            scale(1e6F);
            break;
        case SignalFault::velocities_small:
            scale(0.1F);
            break;
        case SignalFault::velocities_zero:
            scale(0.0F);
            break;
        case SignalFault::velocities_frozen:
            velocity_mm_s = before.axis_velocity_mm_s;
            break;
        case SignalFault::velocities_reversed:
            scale(-1.0F);
            break;
        case SignalFault::velocities_swapped:
            std::swap(velocity_mm_s[0], velocity_mm_s[1]);
            break;
        case SignalFault::not_a_number:
            velocity_mm_s.fill(std::numeric_limits<float>::quiet_NaN());
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_encoder(hal::DriveSample& sample, const hal::DriveSample& before) const {
    const auto scale = [&](double factor) {
        const auto scaled = [&](std::uint32_t count) {
            const auto turned = static_cast<std::int32_t>(count - before.spindle_count);
            return before.spindle_count + static_cast<std::uint32_t>(static_cast<std::int64_t>(factor * turned));
        };
        sample.spindle_count = scaled(sample.spindle_count);
        sample.spindle_index_count = scaled(sample.spindle_index_count);
    };
    switch (fault_) {
        case SignalFault::encoder_double:
            scale(2.0);
            break;
        case SignalFault::encoder_half:
            scale(0.5);
            break;
        case SignalFault::encoder_loses:
            scale(0.97);
            break;
        case SignalFault::encoder_reversed:
            scale(-1.0);
            break;
        case SignalFault::encoder_frozen:
            sample.spindle_count = before.spindle_count;
            [[fallthrough]];
        case SignalFault::index_lost:
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
        case SignalFault::feed_not_a_number:
            program.programmed_feed_mm_s = std::numeric_limits<float>::quiet_NaN();
            break;
        case SignalFault::operator_told_high:
            program.operator_override *= 3.0F;
            break;
        case SignalFault::operator_not_a_number:
            program.operator_override = std::numeric_limits<float>::quiet_NaN();
            break;
        case SignalFault::hold_stuck:
            program.feed_hold = true;
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_time(hal::DriveSample& sample, const hal::DriveSample& before) const {
    const std::uint32_t elapsed_us = sample.time_us - before.time_us;
    switch (fault_) {
        case SignalFault::time_frozen:
            sample.time_us = before.time_us;
            break;
        case SignalFault::time_backwards:
            sample.time_us = before.time_us - elapsed_us;
            break;
        case SignalFault::time_double:
            sample.time_us = before.time_us + 2U * elapsed_us;
            break;
        case SignalFault::time_half:
            sample.time_us = before.time_us + elapsed_us / 2U;
            break;
        default:
            break;
    }
}

}  // namespace millforce::faults
