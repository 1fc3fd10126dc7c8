// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hal/can_frame.hpp"

namespace millforce::sim {

/// A CAN bus in memory with the time that frames take: each participant's frame reaches all others when its bits have
/// gone over the wire; of those that wait, the lowest id goes first. On a bus that carries more than it can, what the
/// participants' queues do not hold is lost. Deterministic.
class LoopbackBus {
  public:
    using Receiver = std::function<void(const hal::CanFrame& frame, std::uint64_t time_us)>;

    /// What happens to a frame on its way. `copies` 0: lost.
    struct Fate {
        int copies = 1;
        std::uint64_t delay_us = 0;
        hal::CanFrame frame{};
    };
    using Fault = std::function<Fate(const hal::CanFrame& frame)>;

    explicit LoopbackBus(double bit_rate = 1e6) : bit_rate_(bit_rate) {}

    /// Returns the participant's number.
    int attach(Receiver receiver);
    void send(int from, const hal::CanFrame& frame, std::uint64_t time_us);
    /// Delivers what arrives up to this time.
    void advance_to(std::uint64_t time_us);
    void set_fault(Fault fault) { fault_ = std::move(fault); }

    [[nodiscard]] std::uint64_t delivered() const { return delivered_; }
    [[nodiscard]] std::uint64_t frame_time_us(const hal::CanFrame& frame) const;

  private:
    struct Waiting {
        int from = 0;
        std::uint64_t ready_us = 0;
        hal::CanFrame frame{};
    };
    [[nodiscard]] std::vector<Waiting>::iterator next(std::uint64_t until_us);

    static constexpr std::size_t most_waiting = 64;

    double bit_rate_;
    std::vector<Receiver> receivers_;
    std::vector<Waiting> waiting_;
    Fault fault_;
    std::uint64_t free_us_ = 0;
    std::uint64_t delivered_ = 0;
};

}  // namespace millforce::sim
