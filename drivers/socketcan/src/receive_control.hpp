// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <ctime>

namespace millforce::socketcan {

/// What the kernel reports with a received frame.
struct ReceiveControl {
    bool has_time = false;
    timespec time{};  ///< CLOCK_REALTIME
    bool has_drops = false;
    std::uint32_t drops = 0;  ///< since the socket was opened, wraps
};
[[nodiscard]] ReceiveControl receive_control(msghdr& message);

}  // namespace millforce::socketcan
