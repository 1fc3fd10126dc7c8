// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "firmware/tick.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

/// The messages between plant and controller when the controller runs on another processor: plain structures over a
/// pair of pipes, one request and one answer per sample. Both sides are little-endian and align alike.

namespace millforce::lock_step {

struct Request {
    hal::DriveSample sample;
    hal::ProgramStatus program;
};
static_assert(sizeof(hal::DriveSample) == 52 && sizeof(hal::ProgramStatus) == 24);

/// The override, and what a trace shows of the estimates; as float whatever the scalar.
struct Answer {
    hal::FeedOverride feed;
    std::uint32_t limit;
    std::uint32_t valid;  ///< bit 0 F_at, 1 F_ax, 2 immersion, 3 depth, 4 tooth force
    std::array<float, 8> value;
    std::uint32_t instructions;  ///< of the step and its longest slice, where the other side counts them
                                 ///< (instruction_counter.hpp)
};
static_assert(sizeof(hal::FeedOverride) == 12 && sizeof(Answer) == 56);

/// What is to be reported of a tick that has just given this override.
template <typename Scalar>
Answer answer_of(const firmware::SmallTick<Scalar>& tick, const hal::FeedOverride& feed) {
    Answer answer{};
    answer.feed = feed;
    const auto& e = tick.estimate();
    answer.limit = static_cast<std::uint32_t>(tick.control().limit);
    answer.valid = (e.tangential_N.valid ? 1U : 0U) | (e.feed_N.valid ? 2U : 0U) |
                   (e.engagement.immersion_valid ? 4U : 0U) | (e.engagement.depth_valid ? 8U : 0U) |
                   (e.tooth_force_N.valid ? 16U : 0U);
    const Scalar shown[] = {e.tangential_N.value,
                            e.tangential_N.variance,
                            e.feed_N.value,
                            e.engagement.radial_immersion,
                            e.engagement.radial_immersion_sd,
                            e.engagement.axial_depth_mm,
                            e.engagement.axial_depth_sd_mm,
                            e.tooth_force_N.value};
    for (std::size_t k = 0; k < answer.value.size(); ++k) {
        answer.value[k] = static_cast<float>(shown[k]);
    }
    return answer;
}

/// Whether two answers are the same to the last bit; the gaps of the structure do not count, nor who counted
/// instructions.
inline bool same_bits(const Answer& a, const Answer& b) {
    bool same = std::bit_cast<std::uint32_t>(a.feed.ratio) == std::bit_cast<std::uint32_t>(b.feed.ratio) &&
                a.feed.hold == b.feed.hold && a.feed.state == b.feed.state && a.feed.fault == b.feed.fault &&
                a.feed.heartbeat == b.feed.heartbeat && a.limit == b.limit && a.valid == b.valid;
    for (std::size_t k = 0; k < a.value.size(); ++k) {
        same = same && std::bit_cast<std::uint32_t>(a.value[k]) == std::bit_cast<std::uint32_t>(b.value[k]);
    }
    return same;
}

}  // namespace millforce::lock_step
