// SPDX-License-Identifier: Apache-2.0
#include "stm32/clock.hpp"

namespace millforce::stm32 {

namespace {

// RCC_CR
constexpr std::uint32_t hse_on = 1U << 16U;
constexpr std::uint32_t hse_ready = 1U << 17U;
constexpr std::uint32_t security_system_on = 1U << 19U;
constexpr std::uint32_t pll_on = 1U << 24U;
constexpr std::uint32_t pll_ready = 1U << 25U;
// RCC_CFGR: the switch, and what it says back
constexpr std::uint32_t switch_pll = 2U;
constexpr std::uint32_t switched_to_pll = 2U << 2U;
constexpr std::uint32_t switched_mask = 3U << 2U;
// RCC_CSR
constexpr std::uint32_t remove_flags = 1U << 24U;

/// 1 MHz into the PLL, 336 MHz out of its oscillator, half of it for the system, a seventh for USB.
constexpr std::uint32_t pll_multiplier = 336;
constexpr std::uint32_t pll_usb_divisor = 7;
constexpr std::uint32_t pll_from_hse = 1U << 22U;

}  // namespace

Clock::Clock(RccRegisters& rcc, FlashRegisters& flash, PwrRegisters& pwr, std::uint32_t crystal_hz,
             std::uint32_t patience)
    : rcc_(rcc), flash_(flash), pwr_(pwr), crystal_MHz_(crystal_hz / 1'000'000U), patience_(patience) {
    constexpr std::uint32_t pwr_clock = 1U << 28U;
    constexpr std::uint32_t voltage_scale_1 = 1U << 14U;
    set_bits(rcc_.apb1enr, pwr_clock);
    set_bits(pwr_.cr, voltage_scale_1);
    set_bits(rcc_.cr, hse_on);
}

ClockState Clock::poll() {
    if (is_settled()) {
        return state_;
    }
    ++polls_;
    const bool is_late = polls_ >= patience_;
    if (state_ == ClockState::crystal_starting) {
        if (has_bits(rcc_.cr, hse_ready)) {
            start_pll();
        } else if (is_late) {
            fail(ClockState::crystal_failed);
        }
    } else if (state_ == ClockState::pll_locking) {
        if (has_bits(rcc_.cr, pll_ready)) {
            switch_to_pll();
        } else if (is_late) {
            fail(ClockState::pll_failed);
        }
    } else if ((rcc_.cfgr & switched_mask) == switched_to_pll) {
        // From now on a crystal that stops is a non-maskable interrupt.
        set_bits(rcc_.cr, security_system_on);
        state_ = ClockState::running;
    } else if (is_late) {
        fail(ClockState::pll_failed);
    }
    return state_;
}

void Clock::start_pll() {
    rcc_.pllcfgr = crystal_MHz_ | pll_multiplier << 6U | pll_from_hse | pll_usb_divisor << 24U;
    // APB1 a quarter, APB2 half of the system clock, before it gets fast.
    constexpr std::uint32_t quarter = 5U;
    constexpr std::uint32_t half = 4U;
    set_field(rcc_.cfgr, 10, 3, quarter);
    set_field(rcc_.cfgr, 13, 3, half);
    set_bits(rcc_.cr, pll_on);
    state_ = ClockState::pll_locking;
    polls_ = 0;
}

void Clock::switch_to_pll() {
    // Five wait states at 168 MHz and 2.7…3.6 V (RM0090 table 10), prefetch and both caches.
    constexpr std::uint32_t prefetch_and_caches = 7U << 8U;
    flash_.acr = prefetch_and_caches | 5U;
    set_field(rcc_.cfgr, 0, 2, switch_pll);
    state_ = ClockState::switching;
    polls_ = 0;
}

void Clock::fail(ClockState state) {
    set_field(rcc_.cfgr, 0, 2, 0);  // internal oscillator
    clear_bits(rcc_.cr, pll_on | hse_on);
    state_ = state;
}

hal::ResetCause take_reset_cause(RccRegisters& rcc) {
    const std::uint32_t flags = rcc.csr;
    set_bits(rcc.csr, remove_flags);
    const auto has = [flags](unsigned bit) { return (flags & (1U << bit)) != 0; };
    if (has(29) || has(30)) {
        return hal::ResetCause::watchdog;
    }
    if (has(31)) {
        return hal::ResetCause::low_power;
    }
    if (has(28)) {
        return hal::ResetCause::software;
    }
    // A power-on sets the brown-out flag too; a brown-out alone does not set the other.
    if (has(27)) {
        return hal::ResetCause::power_on;
    }
    if (has(25)) {
        return hal::ResetCause::brown_out;
    }
    return has(26) ? hal::ResetCause::pin : hal::ResetCause::unknown;
}

void watch_supply(PwrRegisters& pwr) {
    constexpr std::uint32_t enable = 1U << 4U;
    constexpr std::uint32_t highest_level = 7U;
    set_field(pwr.cr, 5, 3, highest_level);
    set_bits(pwr.cr, enable);
}

}  // namespace millforce::stm32
