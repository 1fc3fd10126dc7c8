#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <ctime>

namespace millforce::socketcan {

/// What the kernel says beside a received frame.
struct ReceiveControl {
    bool has_time = false;
    timespec time{};  ///< CLOCK_REALTIME
    bool has_drops = false;
    std::uint32_t drops = 0;  ///< since the socket was opened, wraps
};
[[nodiscard]] ReceiveControl receive_control(msghdr& message);

/// On CLOCK_MONOTONIC. A time that is not within the last second (the clock was set meanwhile) counts as now.
[[nodiscard]] std::uint64_t monotonic_from(const timespec& realtime);

}  // namespace millforce::socketcan
