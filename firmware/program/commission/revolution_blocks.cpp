// SPDX-License-Identifier: Apache-2.0
#include "commission/revolution_blocks.hpp"

#include <cmath>
#include <numbers>

namespace millforce::host {

namespace {

constexpr double shortest_block_s = 0.1;
constexpr double longest_block_s = 5.0;  // a spindle that stands ends none

bool has_spindle(const hal::DriveSample& sample) {
    constexpr std::uint8_t needed = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::spindle_current);
    return (sample.present & needed) == needed;
}

}  // namespace

void RevolutionBlocks::begin(const TimedSample& timed) {
    samples_ = 1;
    start_s_ = timed.time_s;
    last_count_ = timed.sample.spindle_count;
    last_current_A_ = static_cast<double>(timed.sample.spindle_current_A);
    turned_ = 0;
    current_ = squared_steps_ = 0.0;
    velocity_ = {};
}

/// The first sample only marks the begin.
RevolutionBlock RevolutionBlocks::block(const TimedSample& timed) const {
    const auto n = static_cast<double>(samples_ - 1);
    RevolutionBlock block;
    block.start_s = start_s_;
    block.end_s = timed.time_s;
    block.spindle_rad_s =
        static_cast<double>(turned_) / counts_per_rev_ * 2.0 * std::numbers::pi / (timed.time_s - start_s_);
    block.spindle_current_A = current_ / n;
    block.current_noise_A = std::sqrt(squared_steps_ / n / 2.0);
    for (std::size_t axis = 0; axis < velocity_.size(); ++axis) {
        block.velocity_mm_s[axis] = velocity_[axis] / n;
    }
    return block;
}

std::optional<RevolutionBlock> RevolutionBlocks::add(const TimedSample& timed) {
    const hal::DriveSample& sample = timed.sample;
    if (!has_spindle(sample)) {
        reset();
        return std::nullopt;
    }
    if (samples_ == 0 || timed.time_s - start_s_ > longest_block_s) {
        begin(timed);
        return std::nullopt;
    }
    ++samples_;
    turned_ += static_cast<std::int32_t>(sample.spindle_count - last_count_);
    last_count_ = sample.spindle_count;
    const auto current_A = static_cast<double>(sample.spindle_current_A);
    current_ += current_A;
    squared_steps_ += (current_A - last_current_A_) * (current_A - last_current_A_);
    last_current_A_ = current_A;
    for (std::size_t axis = 0; axis < velocity_.size(); ++axis) {
        if (hal::knows_velocity(sample, axis)) {
            velocity_[axis] += static_cast<double>(sample.axis_velocity_mm_s[axis]);
        }
    }
    // The revolution that ends within this sample's step; at the latest after a whole one more.
    const double turns = std::abs(static_cast<double>(turned_)) / counts_per_rev_;
    const double step_turns = turns / static_cast<double>(samples_ - 1);
    const bool is_whole = turns > 0.5 && turns - std::floor(turns) < step_turns;
    if (!is_whole || timed.time_s - start_s_ < shortest_block_s) {
        return std::nullopt;
    }
    const RevolutionBlock found = block(timed);
    begin(timed);
    return found;
}

}  // namespace millforce::host
