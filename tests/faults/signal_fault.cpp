// SPDX-License-Identifier: Apache-2.0
#include "faults/signal_fault.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace millforce::faults {

namespace {

enum class Drive : std::uint8_t { spindle, x, y };

/// The true current times a gain, and what is added to it.
struct CurrentFault {
    SignalFault kind;
    Drive drive;
    float gain = 1.0F;
    double drift_A_per_s = 0.0;
    double offset_of_rated = 0.0;
    double fades_in_s = 0.0;  // the gain is 1 at the begin
};

constexpr CurrentFault current_faults[] = {
    {SignalFault::spindle_weak, Drive::spindle, 0.3F},
    {SignalFault::spindle_strong, Drive::spindle, 3.0F},
    {SignalFault::spindle_drifts, Drive::spindle, 1.0F, -0.5},
    {SignalFault::spindle_drifts_up, Drive::spindle, 1.0F, 0.5},
    {SignalFault::spindle_low, Drive::spindle, 1.0F, 0.0, -0.1},
    {SignalFault::spindle_high, Drive::spindle, 1.0F, 0.0, 0.1},
    {SignalFault::spindle_dead, Drive::spindle, 0.0F},
    {SignalFault::spindle_reversed, Drive::spindle, -1.0F},
    {SignalFault::spindle_fair, Drive::spindle, 0.6F},
    {SignalFault::spindle_fades, Drive::spindle, 0.3F, 0.0, 0.0, 5.0},
    {SignalFault::x_tenfold, Drive::x, 10.0F},
    {SignalFault::x_weak, Drive::x, 0.3F},
    {SignalFault::x_reversed, Drive::x, -1.0F},
    {SignalFault::x_drifts, Drive::x, 1.0F, 0.5},
    {SignalFault::x_drifts_down, Drive::x, 1.0F, -0.5},
    {SignalFault::x_high, Drive::x, 1.0F, 0.0, 0.1},
    {SignalFault::x_dead, Drive::x, 0.0F},
    {SignalFault::x_strong, Drive::x, 1.7F},
    {SignalFault::x_fades, Drive::x, 0.3F, 0.0, 0.0, 5.0},
    {SignalFault::y_tenfold, Drive::y, 10.0F},
    {SignalFault::y_weak, Drive::y, 0.3F},
    {SignalFault::y_reversed, Drive::y, -1.0F},
    {SignalFault::y_drifts, Drive::y, 1.0F, 0.5},
    {SignalFault::y_dead, Drive::y, 0.0F},
    {SignalFault::currents_halved, Drive::spindle, 0.5F},
    {SignalFault::currents_halved, Drive::x, 0.5F},
    {SignalFault::currents_halved, Drive::y, 0.5F},
};
constexpr std::pair<SignalFault, Drive> frozen_currents[] = {{SignalFault::spindle_frozen, Drive::spindle},
                                                             {SignalFault::x_frozen, Drive::x},
                                                             {SignalFault::y_frozen, Drive::y}};

constexpr double lateness_s = 0.2;
constexpr double bursts_per_s = 5.0;

bool is_in_burst(double since_s, double burst_s) {
    return std::fmod(since_s, 1.0 / bursts_per_s) < burst_s;
}

float in_steps(float current_A, double step_A) {
    return static_cast<float>(step_A * std::round(static_cast<double>(current_A) / step_A));
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
                                     "spindle current × 0.6",
                                     "spindle current fades to × 0.3",
                                     "spindle current rectified",
                                     "spindle current 0.2 s late",
                                     "spindle current smoothed, 0.3 s",
                                     "spindle current cuts out",
                                     "spindle current spikes",
                                     "spindle current in steps of 10 %",
                                     "x current × 10",
                                     "x current × 0.3",
                                     "x current reversed",
                                     "x current drifts, 0.5 A/s",
                                     "x current drifts, −0.5 A/s",
                                     "x current +10 % of rated",
                                     "x current frozen",
                                     "x current 0",
                                     "x current × 1.7",
                                     "x current fades to × 0.3",
                                     "x current rectified",
                                     "x current 0.2 s late",
                                     "x current cuts out",
                                     "x current in steps of 10 %",
                                     "y current × 10",
                                     "y current × 0.3",
                                     "y current reversed",
                                     "y current drifts, 0.5 A/s",
                                     "y current frozen",
                                     "y current 0",
                                     "x and spindle currents swapped",
                                     "x and y currents swapped",
                                     "all currents × 0.5",
                                     "velocities × 10⁶",
                                     "velocities × 0.1",
                                     "velocities 0",
                                     "velocities frozen",
                                     "velocities reversed",
                                     "x and y velocities swapped",
                                     "velocities 0.2 s late",
                                     "x velocity 0",
                                     "encoder counts twice",
                                     "encoder counts half",
                                     "encoder loses 3 %",
                                     "encoder reversed",
                                     "index pulse lost",
                                     "encoder frozen",
                                     "encoder absent",
                                     "encoder slips",
                                     "encoder stutters",
                                     "NaN",
                                     "rapid bit stuck",
                                     "F × 0.1",
                                     "F × 10",
                                     "F not a number",
                                     "operator's override × 3",
                                     "operator's override not a number",
                                     "feed hold stuck",
                                     "rapid bit flickers",
                                     "F × 10, flickers",
                                     "program status frozen",
                                     "everything 0.2 s late",
                                     "time frozen",
                                     "time runs backwards",
                                     "time runs twice as fast",
                                     "time runs half as fast",
                                     "time jitters"};
    static_assert(std::size(names) == signal_faults);
    return names[static_cast<std::size_t>(fault)];
}

void SignalCorruption::corrupt(hal::DriveSample& sample, hal::ProgramStatus& program, const hal::DriveSample& before,
                               double since_s) {
    corrupt_by_past(sample, program, since_s);
    corrupt_currents(sample, before, since_s);
    corrupt_single_samples(sample, since_s);
    corrupt_velocities(sample, before);
    corrupt_encoder(sample, before, since_s);
    corrupt_program(program);
    corrupt_time(sample, before);
}

void SignalCorruption::corrupt_currents(hal::DriveSample& sample, const hal::DriveSample& before, double since_s) {
    const auto of = [](auto& of_sample, Drive drive) -> auto& {
        return drive == Drive::spindle ? of_sample.spindle_current_A
                                       : of_sample.axis_current_A[drive == Drive::x ? 0 : 1];
    };
    for (const CurrentFault& fault : current_faults) {
        if (fault.kind == fault_) {
            const double rated_A = fault.drive == Drive::spindle ? rated_.spindle_A : rated_.axis_A;
            const double beside_A = fault.drift_A_per_s * since_s + fault.offset_of_rated * rated_A;
            const double faded = since_s < fault.fades_in_s ? since_s / fault.fades_in_s : 1.0;
            float& current_A = of(sample, fault.drive);
            current_A *= 1.0F + static_cast<float>(faded) * (fault.gain - 1.0F);
            current_A += static_cast<float>(beside_A);
        }
    }
    for (const auto& [kind, drive] : frozen_currents) {
        if (kind == fault_) {
            of(sample, drive) = of(before, drive);
        }
    }
    switch (fault_) {
        case SignalFault::spindle_saturated:
            sample.spindle_current_A = std::min(sample.spindle_current_A, before.spindle_current_A);
            break;
        case SignalFault::spindle_noisy:
            sample.spindle_current_A +=
                static_cast<float>(std::normal_distribution(0.0, 0.1 * rated_.spindle_A)(random_));
            break;
        case SignalFault::spindle_absent:
            make_absent(sample, hal::Present::spindle_current);
            break;
        case SignalFault::spindle_rectified:
            sample.spindle_current_A = std::abs(sample.spindle_current_A);
            break;
        case SignalFault::spindle_coarse:
            sample.spindle_current_A = in_steps(sample.spindle_current_A, 0.1 * rated_.spindle_A);
            break;
        case SignalFault::x_rectified:
            sample.axis_current_A[0] = std::abs(sample.axis_current_A[0]);
            break;
        case SignalFault::x_coarse:
            sample.axis_current_A[0] = in_steps(sample.axis_current_A[0], 0.1 * rated_.axis_A);
            break;
        case SignalFault::x_and_spindle_swapped:
            std::swap(sample.axis_current_A[0], sample.spindle_current_A);
            break;
        case SignalFault::x_and_y_swapped:
            std::swap(sample.axis_current_A[0], sample.axis_current_A[1]);
            break;
        case SignalFault::not_a_number:
            sample.spindle_current_A = std::numeric_limits<float>::quiet_NaN();
            sample.axis_current_A.fill(std::numeric_limits<float>::quiet_NaN());
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_single_samples(hal::DriveSample& sample, double since_s) {
    constexpr double cut_out_s = 0.02;
    constexpr double spikes = 0.01;
    switch (fault_) {
        case SignalFault::spindle_cuts_out:
            sample.spindle_current_A = is_in_burst(since_s, cut_out_s) ? 0.0F : sample.spindle_current_A;
            break;
        case SignalFault::x_cuts_out:
            sample.axis_current_A[0] = is_in_burst(since_s, cut_out_s) ? 0.0F : sample.axis_current_A[0];
            break;
        case SignalFault::spindle_spikes:
            if (std::bernoulli_distribution(spikes)(random_)) {
                sample.spindle_current_A = static_cast<float>(rated_.spindle_A);
            }
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_by_past(hal::DriveSample& sample, hal::ProgramStatus& program, double since_s) {
    constexpr double time_constant_s = 0.3;
    const double dt_s = past_.empty() ? 0.0 : since_s - past_.back().since_s;
    const auto now_A = static_cast<double>(sample.spindle_current_A);
    smoothed_A_ = past_.empty() ? now_A : smoothed_A_ + dt_s / (time_constant_s + dt_s) * (now_A - smoothed_A_);
    past_.push_back({since_s, sample, program});
    while (past_.size() > 1 && past_[1].since_s <= since_s - lateness_s) {
        past_.pop_front();
    }
    const Moment& late = past_.front();
    switch (fault_) {
        case SignalFault::spindle_smoothed:
            sample.spindle_current_A = static_cast<float>(smoothed_A_);
            break;
        case SignalFault::spindle_late:
            sample.spindle_current_A = late.sample.spindle_current_A;
            break;
        case SignalFault::x_late:
            sample.axis_current_A[0] = late.sample.axis_current_A[0];
            break;
        case SignalFault::velocities_late:
            sample.axis_velocity_mm_s = late.sample.axis_velocity_mm_s;
            break;
        case SignalFault::all_late: {
            const std::uint32_t time_us = sample.time_us;
            sample = late.sample;
            sample.time_us = time_us;
            program = late.program;
            break;
        }
        case SignalFault::status_frozen:
            first_program_ = first_program_.value_or(program);
            program = *first_program_;
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
        case SignalFault::x_velocity_zero:
            velocity_mm_s[0] = 0.0F;
            break;
        case SignalFault::not_a_number:
            velocity_mm_s.fill(std::numeric_limits<float>::quiet_NaN());
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_encoder(hal::DriveSample& sample, const hal::DriveSample& before, double since_s) {
    constexpr double stutter_s = 0.03;
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
        case SignalFault::encoder_slips:
            sample.spindle_count += rated_.counts_per_rev / 4U;
            if (sample.spindle_index_number != before.spindle_index_number) {
                sample.spindle_index_count += rated_.counts_per_rev / 4U;
            }
            break;
        case SignalFault::encoder_stutters:
            held_ = held_ && is_in_burst(since_s, stutter_s) ? held_ : sample;
            sample.spindle_count = held_->spindle_count;
            sample.spindle_index_count = held_->spindle_index_count;
            sample.spindle_index_number = held_->spindle_index_number;
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_program(hal::ProgramStatus& program) {
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
        case SignalFault::rapid_flickers:
            program.rapid = every_second_time();
            break;
        case SignalFault::feed_flickers:
            program.programmed_feed_mm_s *= every_second_time() ? 10.0F : 1.0F;
            break;
        case SignalFault::hold_stuck:
            program.feed_hold = true;
            break;
        default:
            break;
    }
}

void SignalCorruption::corrupt_time(hal::DriveSample& sample, const hal::DriveSample& before) {
    constexpr double jitter = 0.4;  // of a sample
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
        case SignalFault::time_jitters: {
            const double sample_us =
                past_.size() < 2 ? 0.0 : 1e6 * (past_.back().since_s - past_[past_.size() - 2].since_s);
            sample.time_us += static_cast<std::uint32_t>(
                std::lround(sample_us * (jitter + std::uniform_real_distribution(-jitter, jitter)(random_))));
            break;
        }
        default:
            break;
    }
}

}  // namespace millforce::faults
