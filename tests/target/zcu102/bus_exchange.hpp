#pragma once

#include <array>
#include <cstdint>

#include "hal/can_frame.hpp"

/// What the plant on the host and its CAN controller in the emulator tell each other over a pair of pipes: the host gives
/// frames to send, the emulator answers with the frames that it heard. Meanwhile the emulator's time stands still. Both
/// sides are little-endian and align alike.

namespace millforce::bus_exchange {

inline constexpr std::size_t most_frames = 64;  ///< the depth of the controller's queues

struct Heard {
    std::uint64_t time_us;
    hal::CanFrame frame;
};

struct Orders {
    std::uint32_t wait_us;  ///< report at the latest then, though nothing was heard
    std::uint32_t count;
    std::array<hal::CanFrame, most_frames> frames;
};

struct Report {
    std::uint64_t now_us;
    std::uint32_t count;
    std::uint32_t lost;  ///< frames that could not be sent, and overruns of the receive queue, since the start
    std::array<Heard, most_frames> heard;
};
static_assert(sizeof(hal::CanFrame) == 16 && sizeof(Heard) == 24);
static_assert(sizeof(Orders) == 8 + 16 * most_frames && sizeof(Report) == 16 + 24 * most_frames);

}  // namespace millforce::bus_exchange
