// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/tick_record.hpp"

namespace millforce::host {

/// A tick at the controller's border, as a run's log and a replay have it.
struct EstimateEntry {
    std::uint64_t digest = 0;  ///< of all ticks since the start, this one too
    firmware::TickRecord tick{};
    std::uint32_t tool = 0;  ///< that the tick's override is for; 0: one tool, or not known
};

inline constexpr std::uint64_t run_log_interval_us = 20'000;

/// Which ticks become entries, and what all of them were: a number that differs where one bit of one tick does.
class TickEntries {
  public:
    explicit TickEntries(std::uint64_t interval_us) : interval_us_(interval_us) {}

    /// With each tick; true where it is an entry.
    [[nodiscard]] bool add(const firmware::TickRecord& tick, std::uint32_t tool, EstimateEntry& entry);

  private:
    void mix(std::uint32_t high, std::uint32_t low);

    std::uint64_t interval_us_;
    std::uint64_t next_us_ = 0;
    std::uint64_t digest_ = 0;
};

}  // namespace millforce::host
