// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zynqmp/can_controller.hpp"

/// What the controller's hardware does between two looks at its registers.
class FakeZynqCan {
  public:
    FakeZynqCan() { registers.sr = setup; }

    millforce::zynqmp::CanRegisters registers{};

    static constexpr std::uint32_t setup = 1U << 0U;
    static constexpr std::uint32_t normal = 1U << 3U;

    /// SR follows SRR; what ICR names is no longer in ISR.
    void react() {
        registers.sr = (registers.srr & 2U) != 0 ? normal : setup;
        registers.isr = registers.isr & ~registers.icr;
        registers.icr = 0;
    }
    void arrive(std::uint32_t identifier, std::uint32_t length, std::uint32_t data1, std::uint32_t data2) {
        registers.receive.identifier = identifier;
        registers.receive.length = length << 28U | 0x1234U;  // and a time stamp
        registers.receive.data1 = data1;
        registers.receive.data2 = data2;
        registers.isr = registers.isr | 1U << 7U;
    }
};
