// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zynqmp/registers.hpp"

/// The system watchdog of the low-power domain. UG1085 chapter 14, UG1087 modules SWDT and PMU_GLOBAL

namespace millforce::zynqmp {

/// Counts down from 4096 (CRV + 1) - 1 periods of its clock divided by 8. At zero the error logic resets the whole
/// processing system, the application processors too; the protection units must let this processor reach PMU_GLOBAL.
class Watchdog {
  public:
    Watchdog(WatchdogRegisters& registers, ErrorRegisters& errors) : registers_(registers), errors_(errors) {}

    /// `clock_MHz`: LPD_LSBUS_CLK, 100 on a ZCU102. 0.33 ms … 1.34 s at 100 MHz, in steps of 0.33 ms, rounded down.
    void start(std::uint32_t timeout_us, std::uint32_t clock_MHz);
    void feed();
    [[nodiscard]] bool is_started() const { return started_; }

  private:
    WatchdogRegisters& registers_;
    ErrorRegisters& errors_;
    bool started_ = false;
};

}  // namespace millforce::zynqmp
