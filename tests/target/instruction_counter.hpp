// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::target {

/// Instructions by the SysTick, on an emulator whose time they are (MILLFORCE_ICOUNT=1): one takes 128 ns, 3.2 counts
/// of the board's 25 MHz. Otherwise the numbers are the host's time and mean nothing. 24 bits: up to 5 million.
class InstructionCounter {
  public:
    InstructionCounter() {
        at(0x14) = 0xFF'FFFFU;
        at(0x18) = 0;
        at(0x10) = 5;  // on, by the processor's clock, no interrupt
        const std::uint32_t start = now();
        asm volatile("" ::: "memory");
        empty_ = between(start, now());
    }

    [[nodiscard]] std::uint32_t now() const { return at(0x18); }
    /// Without those of the two readings themselves.
    [[nodiscard]] std::uint32_t since(std::uint32_t start) const {
        return (10U * (between(start, now()) - empty_) + 16U) / 32U;
    }

  private:
    [[nodiscard]] static std::uint32_t between(std::uint32_t start, std::uint32_t end) {
        return (start - end) & 0xFF'FFFFU;  // it counts down
    }
    static volatile std::uint32_t& at(std::uintptr_t offset) {
        return *reinterpret_cast<volatile std::uint32_t*>(0xE000'E000U + offset);
    }

    std::uint32_t empty_ = 0;
};

}  // namespace millforce::target
