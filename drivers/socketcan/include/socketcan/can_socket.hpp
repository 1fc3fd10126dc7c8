// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/can_frame.hpp"
#include "socketcan/error_frame.hpp"
#include "socketcan/interface_query.hpp"
#include "socketcan/stamp_clock.hpp"

/// One CAN interface of a Linux kernel, `can0` or `vcan0`, as a raw socket that never blocks, reopens itself, and
/// reports to the supervisor what is wrong with the bus.
///
///     CanSocket socket(settings);
///     while (...) {
///         socket.wait(timeout_us);
///         socket.poll(monotonic_us());                            // opens; looks after the interface
///         while (socket.receive(frame, time_us)) { ... }
///         socket.send(frame);
///     }
///
/// No heap; every call but wait() returns at once. One thread per socket. Frames that this socket sent are received by
/// it where `receive_own` asks for them; those of other programs on this machine are. CAN FD frames are counted and not
/// handed over. A controller in bus-off stays there unless the interface was configured to restart: `ip link set can0
/// type can restart-ms 100`.

namespace millforce::socketcan {

/// The worst that is known. Each names what leads out of it.
enum class LinkState : std::uint8_t {
    absent,         ///< no such interface, or a kernel without CAN; opened as soon as it appears
    down,           ///< the interface exists but is not up; left when it is set up
    error_active,   ///< frames flow
    error_warning,  ///< frames flow; left by an error frame that says so
    error_passive,  ///< the same
    bus_off,        ///< nothing flows; left by the controller's restart
};

struct LinkHealth {
    LinkState state = LinkState::absent;
    bool send_queue_full = false;  ///< the last send() found no room; cleared by the next that does
    int last_error = 0;            ///< errno of the last call that failed, 0: none did
    std::uint32_t opened = 0;      ///< times that the socket was opened
    std::uint32_t received = 0;    ///< frames handed over
    std::uint32_t sent = 0;
    std::uint32_t send_failures = 0;  ///< frames not sent, whatever the reason
    std::uint32_t overruns = 0;  ///< frames that the kernel dropped because they were not fetched in time (SO_RXQ_OVFL)
    std::uint32_t controller_overflows = 0;
    std::uint32_t fd_frames = 0;
    std::uint32_t error_frames = 0;
    std::uint32_t bus_offs = 0;
    std::uint32_t restarts = 0;
    std::uint32_t malformed = 0;  ///< reads that are no CAN frame
};

inline constexpr std::size_t interface_name_capacity = 16;  // IFNAMSIZ
inline constexpr std::size_t filter_capacity = 64;

struct CanSocketSettings {
    std::array<char, interface_name_capacity> interface {};
    std::array<hal::CanFilter, filter_capacity> filters{};
    std::size_t filter_count = 0;  ///< 0: every frame passes, 29-bit ids and remote frames too
    bool receive_own = false;      ///< frames that this socket sent come back when they were on the bus
    int receive_buffer_bytes = 1 << 20;
    std::uint32_t look_period_us = 50'000;  ///< between looks at the interface, and between tries to open it

    /// False where the name is empty or longer than 15 characters.
    bool set_interface(std::string_view name);
};

struct ReceivedFrame {
    hal::CanFrame frame{};
    std::uint64_t time_us = 0;  ///< when the kernel got it
    bool is_own = false;        ///< sent by this socket
};

/// CLOCK_MONOTONIC, in which all times of this driver are given.
[[nodiscard]] std::uint64_t monotonic_us();

class CanSocket {
  public:
    explicit CanSocket(const CanSocketSettings& settings);
    ~CanSocket();
    CanSocket(const CanSocket&) = delete;
    CanSocket& operator=(const CanSocket&) = delete;

    void poll(std::uint64_t now_us);
    [[nodiscard]] bool receive(ReceivedFrame& received);
    [[nodiscard]] bool receive(hal::CanFrame& frame, std::uint64_t& time_us);
    /// False: not sent, see health().
    bool send(const hal::CanFrame& frame);
    /// Added to a frame's time_us it gives µs since 1970, as candump prints them.
    [[nodiscard]] std::int64_t unix_offset_us() { return clock_.unix_offset_us(); }
    /// Until a frame arrives or the time is over; while the interface is absent, until the time is over.
    void wait(std::uint64_t timeout_us) const;

    [[nodiscard]] const LinkHealth& health() const { return health_; }
    [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
    /// Frames can flow.
    [[nodiscard]] bool is_up() const {
        return health_.state != LinkState::absent && health_.state != LinkState::down &&
               health_.state != LinkState::bus_off;
    }

  private:
    enum class Fetched : std::uint8_t { frame, skipped, nothing };

    void open();
    [[nodiscard]] bool configure() const;
    [[nodiscard]] bool set_filters() const;
    [[nodiscard]] bool bind_to_interface();
    void close();
    void look_at_interface();
    void enter(LinkState state);
    [[nodiscard]] Fetched fetch(ReceivedFrame& received);
    void take_error_frame(std::uint32_t id, std::span<const std::uint8_t> data);
    void on_failure(int error);

    CanSocketSettings settings_;
    LinkHealth health_{};
    InterfaceQuery query_{};
    StampClock clock_{};
    int descriptor_ = -1;
    int interface_index_ = 0;
    std::uint32_t kernel_drops_ = 0;
    std::uint64_t next_look_us_ = 0;
    std::uint64_t next_clock_look_us_ = 0;
    std::uint64_t recent_us_ = 0;
};

}  // namespace millforce::socketcan
