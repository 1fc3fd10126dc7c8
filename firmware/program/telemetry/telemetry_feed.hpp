// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "run_log/spsc_ring.hpp"
#include "telemetry/telemetry_sample.hpp"

namespace millforce::host {

/// From the real-time thread to one thread that watches. 1 MB of memory.
class TelemetryFeed {
  public:
    /// Once per tick. Neither waits nor allocates; one copy of the sample. What does not fit is counted.
    void put(const TelemetrySample& sample) {
        if (!samples_.push(sample)) {
            lost_.fetch_add(1, std::memory_order_relaxed);
        }
    }
    /// The oldest that was not taken yet; false: none.
    [[nodiscard]] bool take(TelemetrySample& sample) { return samples_.pop(sample); }
    [[nodiscard]] std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

  private:
    /// A fifth of a second at 20 kHz.
    static constexpr std::size_t capacity = 1U << 12U;

    SpscRing<TelemetrySample, capacity> samples_{};
    std::atomic<std::uint64_t> lost_{0};
};

}  // namespace millforce::host
