#pragma once

#include <cstdint>

namespace millforce::sim {

/// The time of a bus: µs since 1970, and in slow motion so many times slower. All time-outs and periods on the bus are
/// in this time, so that the whole bus, drives and CNC too, runs slower beside a computer that is busy. The plant, the
/// controller and a replay must be given the same slowness; a recorded stamp gives the same time to all of them.
class BusClock {
  public:
    /// `unix_offset_us`: what a monotonic time lacks to the time since 1970, now. It is kept where the clock is set.
    explicit BusClock(std::uint32_t slowness = 1, std::int64_t unix_offset_us = 0)
        : slowness_(slowness), offset_us_(unix_offset_us) {}

    [[nodiscard]] std::uint64_t of_unix(std::uint64_t unix_us) const { return unix_us / slowness_; }
    [[nodiscard]] std::uint64_t of_monotonic(std::uint64_t time_us) const {
        return of_unix(static_cast<std::uint64_t>(static_cast<std::int64_t>(time_us) + offset_us_));
    }
    /// How long that lasts on a clock.
    [[nodiscard]] std::uint64_t real_us(std::uint64_t duration_us) const { return duration_us * slowness_; }

  private:
    std::uint64_t slowness_;
    std::int64_t offset_us_;
};

inline constexpr std::uint32_t largest_slowness = 1000;

}  // namespace millforce::sim
