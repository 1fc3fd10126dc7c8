// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hal/reset_cause.hpp"
#include "stm32/registers.hpp"

/// System clock of an STM32F405: 168 MHz from a crystal. RM0090 7.2, 3.5.

namespace millforce::stm32 {

inline constexpr std::uint32_t system_clock_hz = 168'000'000;
inline constexpr std::uint32_t apb1_clock_hz = 42'000'000;
inline constexpr std::uint32_t apb1_timer_clock_hz = 84'000'000;
inline constexpr std::uint32_t apb2_timer_clock_hz = 168'000'000;

enum class ClockState : std::uint8_t {
    crystal_starting,
    pll_locking,
    switching,
    running,         ///< 168 MHz
    crystal_failed,  ///< no crystal within the given polls; the chip runs on its internal 16 MHz
    pll_failed,      ///< the same
};

/// Brings the clock up step by step; poll() until is_settled(). Each wait ends after `patience` polls. One thread.
class Clock {
  public:
    /// `crystal_hz`: a whole number of MHz, 4…26.
    Clock(RccRegisters& rcc, FlashRegisters& flash, PwrRegisters& pwr, std::uint32_t crystal_hz,
          std::uint32_t patience);

    ClockState poll();
    [[nodiscard]] ClockState state() const { return state_; }
    [[nodiscard]] bool is_settled() const { return state_ >= ClockState::running; }

  private:
    void start_pll();
    void switch_to_pll();
    void fail(ClockState state);

    RccRegisters& rcc_;
    FlashRegisters& flash_;
    PwrRegisters& pwr_;
    std::uint32_t crystal_MHz_;
    std::uint32_t patience_;
    std::uint32_t polls_ = 0;
    ClockState state_ = ClockState::crystal_starting;
};

/// Reads the flags and clears them, so that the next start reports its own cause. RM0090 7.3.21
hal::ResetCause take_reset_cause(RccRegisters& rcc);

/// Watches the supply: the comparator at 2.9 V, the highest level. RM0090 5.4
void watch_supply(PwrRegisters& pwr);
inline bool supply_is_low(const PwrRegisters& pwr) {
    return has_bits(pwr.csr, 1U << 2U);
}

}  // namespace millforce::stm32
