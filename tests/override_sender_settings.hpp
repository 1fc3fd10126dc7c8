// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "override_frame/override_sender.hpp"

namespace millforce::test {

/// A frame every 2 ms and a heartbeat every 100 ms, as the node that receivers expect.
inline override_frame::OverrideSenderSettings an_override_sender() {
    return {.node_id = override_frame::default_node_id,
            .id = override_frame::default_id,
            .period_us = 2'000,
            .heartbeat_period_us = 100'000};
}

}  // namespace millforce::test
