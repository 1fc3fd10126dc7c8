// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/tick.hpp"

namespace millforce::firmware {

/// The tools that the CNC may call by their numbers, from 1 on, all on one machine. Called by the thread of the tick,
/// between two samples and at rest. Building a tick from parameters takes some milliseconds on a desktop
/// processor: where the CNC does not wait for that long, have the ticks ready and copy them (ready_tools.hpp).
class ToolSource {
  public:
    /// Never tool 0.
    [[nodiscard]] virtual bool has(std::uint32_t number) const = 0;
    /// Makes `tick` a fresh one of this tool; of any tool where there is none with this number.
    virtual void set_up(std::uint32_t number, ForceControlTick<float>& tick) const = 0;

  protected:
    ~ToolSource() = default;
};

}  // namespace millforce::firmware
