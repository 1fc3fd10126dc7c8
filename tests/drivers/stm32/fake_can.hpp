// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stm32/can_controller.hpp"

#include <vector>

/// What the controller's hardware does between two looks at its registers.
class FakeCan {
  public:
    static constexpr std::uint32_t all_empty = 7U << 26U;

    FakeCan() { registers.tsr = all_empty; }

    millforce::stm32::CanRegisters registers{};

    /// Follows the requests of MCR, TSR and RF0R.
    void react() {
        registers.msr = registers.mcr & 1U;
        if ((registers.tsr & 1U << 7U) != 0) {
            registers.tsr = all_empty;
            for (auto& box : registers.transmit) {
                box.identifier = box.identifier & ~1U;
            }
        }
        registers.rf0r = registers.rf0r & ~(1U << 4U | 1U << 5U);
    }
    /// The requested frames leave.
    std::vector<millforce::hal::CanFrame> sent() {
        std::vector<millforce::hal::CanFrame> frames;
        for (auto& box : registers.transmit) {
            if ((box.identifier & 1U) != 0) {
                frames.push_back(frame_of(box));
                box.identifier = box.identifier & ~1U;
            }
        }
        registers.tsr = all_empty;
        return frames;
    }
    /// The mailboxes that hold a request are not empty.
    void occupy() {
        std::uint32_t empty = 0;
        for (unsigned k = 0; k < 3; ++k) {
            empty |= (registers.transmit[k].identifier & 1U) == 0 ? 1U << (26U + k) : 0U;
        }
        registers.tsr = empty;
    }
    void arrive(std::uint32_t identifier, std::uint32_t length, std::uint32_t low, std::uint32_t high) {
        registers.receive[0].identifier = identifier;
        registers.receive[0].length = length;
        registers.receive[0].low = low;
        registers.receive[0].high = high;
        registers.rf0r = 1;
    }
    void join_bus(millforce::stm32::CanController& controller) {
        join_bus_with([&controller] { controller.poll(100); });
    }
    template <typename Poll>
    void join_bus_with(Poll poll) {
        for (unsigned k = 0; k < 4; ++k) {
            react();
            poll();
        }
    }

  private:
    static millforce::hal::CanFrame frame_of(const millforce::stm32::CanMailboxRegisters& box) {
        millforce::hal::CanFrame frame;
        const std::uint32_t identifier = box.identifier;
        frame.extended = (identifier & 4U) != 0;
        frame.remote = (identifier & 2U) != 0;
        frame.id = frame.extended ? identifier >> 3U : identifier >> 21U;
        frame.length = static_cast<std::uint8_t>((box.length & 0xFU) < 8U ? box.length & 0xFU : 8U);
        for (unsigned k = 0; k < 8U && k < frame.length; ++k) {
            const std::uint32_t word = k < 4 ? box.low : box.high;
            frame.data[k] = static_cast<std::uint8_t>(word >> (8U * (k % 4U)));
        }
        return frame;
    }
};
