// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Velocities and a plausible angle out of encoder counts.

namespace millforce::stm32_h405 {

/// Mean velocity over the last eight readings: a resolution of an eighth of a count per period, half of the span late.
class AxisVelocity {
  public:
    /// mm/s; 0 with the first reading.
    float update(std::uint32_t count, std::uint32_t time_us, float mm_per_count) {
        newest_ = (newest_ + 1U) % span;
        readings_[newest_] = {count, time_us};
        known_ += known_ < span ? 1U : 0U;
        const Reading& oldest = readings_[(newest_ + span + 1U - known_) % span];
        const auto counts = static_cast<std::int32_t>(count - oldest.count);
        const std::uint32_t elapsed_us = time_us - oldest.time_us;
        return elapsed_us == 0 ? 0.0F
                               : static_cast<float>(counts) * mm_per_count * 1e6F / static_cast<float>(elapsed_us);
    }

  private:
    static constexpr std::size_t span = 9;
    struct Reading {
        std::uint32_t count = 0;
        std::uint32_t time_us = 0;
    };
    std::array<Reading, span> readings_{};
    std::size_t newest_ = 0;
    std::size_t known_ = 0;
};

/// Whether a spindle encoder counts what its index says: whole revolutions between two pulses, and a pulse at least
/// every second revolution. A broken wire, lost counts or a wrong number of lines are found so; without an index wired
/// nothing is. An encoder that failed is used again after two good revolutions.
class EncoderWatch {
  public:
    explicit EncoderWatch(std::uint32_t counts_per_rev) : counts_per_rev_(counts_per_rev) {}

    bool is_plausible(std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number) {
        if (index_number != index_number_) {
            judge(magnitude(index_count - index_count_));
            index_number_ = index_number;
            index_count_ = index_count;
            has_index_ = true;
        } else if (has_index_ && magnitude(count - index_count_) > 2U * counts_per_rev_ + tolerance()) {
            good_ = 0;
        }
        return good_ >= trusted;
    }

  private:
    static constexpr unsigned trusted = 2;
    static std::uint32_t magnitude(std::uint32_t difference) {
        return difference < 0x8000'0000U ? difference : 0U - difference;
    }
    /// Edges of A, B and the index are not the same moment, and the two directions meet it at its two ends.
    [[nodiscard]] std::uint32_t tolerance() const { return counts_per_rev_ / 64U + 4U; }
    void judge(std::uint32_t counts) {
        const std::uint32_t rest = counts_per_rev_ != 0 ? counts % counts_per_rev_ : 0;
        const bool is_whole = rest <= tolerance() || rest + tolerance() >= counts_per_rev_;
        if (has_index_) {
            good_ = is_whole ? (good_ < trusted ? good_ + 1U : trusted) : 0U;
        }
    }

    std::uint32_t counts_per_rev_;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
    bool has_index_ = false;
    unsigned good_ = trusted;
};

}  // namespace millforce::stm32_h405
