// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "socketcan/can_socket.hpp"

namespace millforce::host {

/// A CAN interface as the plant uses it: of this computer, or of an emulator whose time is not ours.
class CanPort {
  public:
    virtual ~CanPort() = default;
    [[nodiscard]] virtual std::uint64_t now_us() = 0;
    virtual void poll(std::uint64_t now_us) = 0;
    [[nodiscard]] virtual bool receive(hal::CanFrame& frame, std::uint64_t& time_us) = 0;
    virtual void send(const hal::CanFrame& frame) = 0;
    /// Until a frame arrives, or the time is over.
    virtual void wait(std::uint64_t timeout_us) = 0;
};

/// An interface of this computer.
class SocketPort final : public CanPort {
  public:
    explicit SocketPort(const socketcan::CanSocketSettings& settings) : socket_(settings) {}

    [[nodiscard]] std::uint64_t now_us() override { return socketcan::monotonic_us(); }
    void poll(std::uint64_t now_us) override { socket_.poll(now_us); }
    [[nodiscard]] bool receive(hal::CanFrame& frame, std::uint64_t& time_us) override {
        return socket_.receive(frame, time_us);
    }
    void send(const hal::CanFrame& frame) override { socket_.send(frame); }
    void wait(std::uint64_t timeout_us) override { socket_.wait(timeout_us); }

  private:
    socketcan::CanSocket socket_;
};

}  // namespace millforce::host
