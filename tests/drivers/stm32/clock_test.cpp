// SPDX-License-Identifier: Apache-2.0
#include "stm32/clock.hpp"

#include "stm32/gpio.hpp"
#include "stm32/watchdog.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::stm32;
using millforce::hal::ResetCause;

TEST_GROUP(Stm32Clock) {
    static constexpr std::uint32_t crystal_hz = 8'000'000;
    static constexpr std::uint32_t patience = 10;
    RccRegisters rcc{};
    FlashRegisters flash{};
    PwrRegisters pwr{};
};

TEST(Stm32Clock, asks_for_the_crystal_first) {
    const Clock clock(rcc, flash, pwr, crystal_hz, patience);
    UNSIGNED_LONGS_EQUAL(1U << 16U, rcc.cr);       // HSEON
    UNSIGNED_LONGS_EQUAL(1U << 28U, rcc.apb1enr);  // PWREN
    UNSIGNED_LONGS_EQUAL(1U << 14U, pwr.cr);       // VOS
    CHECK_FALSE(clock.is_settled());
}

TEST(Stm32Clock, makes_168_MHz_of_8) {
    Clock clock(rcc, flash, pwr, crystal_hz, patience);
    LONGS_EQUAL(ClockState::crystal_starting, clock.poll());
    rcc.cr = rcc.cr | 1U << 17U;  // HSERDY
    LONGS_EQUAL(ClockState::pll_locking, clock.poll());
    UNSIGNED_LONGS_EQUAL(8, rcc.pllcfgr & 0x3FU);           // M: 1 MHz
    UNSIGNED_LONGS_EQUAL(336, rcc.pllcfgr >> 6U & 0x1FFU);  // N: 336 MHz
    UNSIGNED_LONGS_EQUAL(0, rcc.pllcfgr >> 16U & 3U);       // P: half
    UNSIGNED_LONGS_EQUAL(1, rcc.pllcfgr >> 22U & 1U);       // from HSE
    UNSIGNED_LONGS_EQUAL(7, rcc.pllcfgr >> 24U & 0xFU);     // Q: 48 MHz
    UNSIGNED_LONGS_EQUAL(5, rcc.cfgr >> 10U & 7U);          // APB1 a quarter
    UNSIGNED_LONGS_EQUAL(4, rcc.cfgr >> 13U & 7U);          // APB2 half
    CHECK_TRUE((rcc.cr & 1U << 24U) != 0);                  // PLLON
    UNSIGNED_LONGS_EQUAL(0, flash.acr);
    rcc.cr = rcc.cr | 1U << 25U;  // PLLRDY
    LONGS_EQUAL(ClockState::switching, clock.poll());
    UNSIGNED_LONGS_EQUAL(0x705, flash.acr);  // wait states before the speed
    UNSIGNED_LONGS_EQUAL(2, rcc.cfgr & 3U);
    rcc.cfgr = rcc.cfgr | 2U << 2U;  // SWS
    LONGS_EQUAL(ClockState::running, clock.poll());
    CHECK_TRUE((rcc.cr & 1U << 19U) != 0);  // CSSON
}

TEST(Stm32Clock, a_crystal_that_does_not_start_leaves_the_internal_clock) {
    Clock clock(rcc, flash, pwr, crystal_hz, patience);
    for (std::uint32_t poll = 0; poll + 1 < patience; ++poll) {
        LONGS_EQUAL(ClockState::crystal_starting, clock.poll());
    }
    LONGS_EQUAL(ClockState::crystal_failed, clock.poll());
    UNSIGNED_LONGS_EQUAL(0, rcc.cr & (1U << 16U | 1U << 24U));
    UNSIGNED_LONGS_EQUAL(0, rcc.cfgr & 3U);
    rcc.cr = rcc.cr | 1U << 17U;
    LONGS_EQUAL(ClockState::crystal_failed, clock.poll());
}

TEST(Stm32Clock, a_PLL_that_does_not_lock_leaves_the_internal_clock) {
    Clock clock(rcc, flash, pwr, crystal_hz, patience);
    rcc.cr = rcc.cr | 1U << 17U;
    for (std::uint32_t poll = 0; poll < patience; ++poll) {
        LONGS_EQUAL(ClockState::pll_locking, clock.poll());
    }
    LONGS_EQUAL(ClockState::pll_failed, clock.poll());
    CHECK_TRUE(clock.is_settled());
}

TEST(Stm32Clock, each_reset_tells_its_cause_once) {
    struct Case {
        std::uint32_t flags;
        ResetCause cause;
    };
    // The pin is pulled by every reset of the chip itself, too.
    const Case cases[] = {
        {0x0E00'0000U, ResetCause::power_on},  {0x0600'0000U, ResetCause::brown_out},
        {0x0400'0000U, ResetCause::pin},       {0x1400'0000U, ResetCause::software},
        {0x2400'0000U, ResetCause::watchdog},  {0x4400'0000U, ResetCause::watchdog},
        {0x8400'0000U, ResetCause::low_power}, {0, ResetCause::unknown},
    };
    for (const Case& c : cases) {
        rcc.csr = c.flags;
        LONGS_EQUAL(c.cause, take_reset_cause(rcc));
        CHECK_TRUE((rcc.csr & 1U << 24U) != 0);  // RMVF
    }
    STRCMP_EQUAL("brown-out", name(ResetCause::brown_out));
}

TEST(Stm32Clock, the_supply_is_watched_at_the_highest_level) {
    watch_supply(pwr);
    UNSIGNED_LONGS_EQUAL(0xF0, pwr.cr);  // PLS 7, PVDE
    CHECK_FALSE(supply_is_low(pwr));
    pwr.csr = 1U << 2U;
    CHECK_TRUE(supply_is_low(pwr));
}

TEST_GROUP(Stm32Gpio) {
    GpioRegisters port{};
};

TEST(Stm32Gpio, a_pin_gets_its_function_and_leaves_its_neighbours) {
    port.moder = 0xFFFF'FFFFU;
    port.afr[1] = 0xFFFF'FFFFU;
    set_alternate_function(port, 9, 9, Pull::up);
    UNSIGNED_LONGS_EQUAL(0xFFFB'FFFFU, port.moder);
    UNSIGNED_LONGS_EQUAL(0xFFFF'FF9FU, port.afr[1]);
    UNSIGNED_LONGS_EQUAL(0, port.afr[0]);
    UNSIGNED_LONGS_EQUAL(1U << 18U, port.pupdr);
    UNSIGNED_LONGS_EQUAL(2U << 18U, port.ospeedr);
}

TEST(Stm32Gpio, an_analogue_pin_has_no_pull) {
    port.pupdr = 0xFFFF'FFFFU;
    set_analogue(port, 3);
    UNSIGNED_LONGS_EQUAL(3U << 6U, port.moder);
    UNSIGNED_LONGS_EQUAL(0xFFFF'FF3FU, port.pupdr);
}

TEST_GROUP(Stm32Watchdog) {
    WatchdogRegisters registers{};
};

TEST(Stm32Watchdog, twenty_milliseconds_are_160_counts) {
    Watchdog watchdog(registers);
    watchdog.start(20'000);
    UNSIGNED_LONGS_EQUAL(0x5555, registers.kr);
    UNSIGNED_LONGS_EQUAL(0, registers.pr);
    UNSIGNED_LONGS_EQUAL(159, registers.rlr);
    watchdog.feed();
    UNSIGNED_LONGS_EQUAL(0xAAAA, registers.kr);
}

TEST(Stm32Watchdog, is_not_fed_before_it_runs_and_keeps_to_its_range) {
    Watchdog watchdog(registers);
    watchdog.feed();
    UNSIGNED_LONGS_EQUAL(0, registers.kr);
    watchdog.start(10'000'000);
    UNSIGNED_LONGS_EQUAL(0xFFF, registers.rlr);
    watchdog.start(1);
    UNSIGNED_LONGS_EQUAL(0, registers.rlr);
}
