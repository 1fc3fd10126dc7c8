// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/feed_override.hpp"

namespace millforce::hal {

/// Health of an output, for the supervisor.
struct OutputHealth {
    bool is_ready = false;       ///< the output is open and accepted the last write
    bool ticks = false;          ///< false: none yet, or none within the time-out; the output is then at its safe value
    int last_error = 0;          ///< errno of the last call that failed; 0: none
    std::uint32_t failures = 0;  ///< writes that were not accepted; saturates
};

/// A way for the override to reach the CNC: CAN frame, analogue voltage, hold line. update() with each tick's output,
/// poll() at least every 5 ms whether ticks come or not. Neither blocks, allocates or throws. One thread.
/// drivers/README.md says what a CNC sees of each output when the controller dies.
class OverrideOutput {
  public:
    virtual void update(const FeedOverride& feed_override, std::uint64_t time_us) = 0;
    virtual void poll(std::uint64_t time_us) = 0;
    [[nodiscard]] virtual OutputHealth health() const = 0;

  protected:
    OverrideOutput() = default;
    ~OverrideOutput() = default;  // never deleted through this interface: that would need a heap
    OverrideOutput(const OverrideOutput&) = default;
    OverrideOutput& operator=(const OverrideOutput&) = default;
};

}  // namespace millforce::hal
