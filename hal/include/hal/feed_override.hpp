// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::hal {

/// What the controller sends to the CNC, once per tick.
struct FeedOverride {
    float ratio = 0.0F;           ///< multiple of the programmed feed; always finite and within the configured limits
    bool hold = true;             ///< stop the feed (feed inhibit), whatever the ratio says
    std::uint8_t state = 0;       ///< control::CutState
    std::uint8_t fault = 0;       ///< control::Fault, latched; 0: none
    std::uint32_t heartbeat = 0;  ///< increases by one per tick: a frozen count means a dead controller
};

}  // namespace millforce::hal
