// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "stm32/registers.hpp"

/// The independent watchdog. RM0090 21

namespace millforce::stm32 {

/// Starts at start() and cannot be stopped. Its clock is an RC oscillator of 17…47 kHz, 32 nominal (data sheet table
/// 35): `timeout_us` holds for the nominal one, and the true time is 0.68 to 1.9 of it.
class Watchdog {
  public:
    explicit Watchdog(WatchdogRegisters& registers) : registers_(registers) {}

    /// 125 µs … 0.5 s.
    void start(std::uint32_t timeout_us);
    void feed();
    [[nodiscard]] bool is_started() const { return started_; }

  private:
    WatchdogRegisters& registers_;
    bool started_ = false;
};

}  // namespace millforce::stm32
