// SPDX-License-Identifier: Apache-2.0
#include "zynqmp/watchdog.hpp"
#include "zynqmp/reset_cause.hpp"

#include <array>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::zynqmp;

namespace {

/// Writes that lack their key are lost, as on the chip; the counter goes down in microseconds of a clock of 100 MHz.
class FakeWatchdog {
  public:
    WatchdogRegisters registers{};
    ErrorRegisters errors{};
    bool has_reset = false;

    void react() {
        if (registers.mode >> 12U == 0xABCU) {
            is_enabled_ = (registers.mode & 1U) != 0;
            resets_ = (registers.mode & 2U) != 0;
        }
        if (registers.control >> 14U == 0x248U) {
            restart_value_ = registers.control >> 2U & 0xFFFU;
            constexpr std::array<std::uint32_t, 4> dividers{8, 64, 512, 4096};
            divider_ = dividers[registers.control & 3U];
        }
        if (registers.restart == 0x1999U) {
            counts_ = restart_value_ << 12U | 0xFFFU;
        }
        registers.mode = 0;
        registers.control = 0;
        registers.restart = 0;
    }
    void pass(std::uint32_t us) {
        react();
        const std::uint32_t counted = us * 100U / divider_;
        const bool is_at_zero = is_enabled_ && counted >= counts_;
        counts_ -= counted < counts_ ? counted : counts_;
        constexpr std::uint32_t lpd_watchdog = 1U << 12U;
        has_reset = has_reset || (is_at_zero && resets_ && (errors.system_reset_enable_1 & lpd_watchdog) != 0 &&
                                  (errors.enable_1 & lpd_watchdog) != 0);
    }

  private:
    bool is_enabled_ = false;
    bool resets_ = false;
    std::uint32_t restart_value_ = 0;
    std::uint32_t divider_ = 8;
    std::uint32_t counts_ = 0;
};

}  // namespace

TEST_GROUP(ZynqWatchdog) {
    FakeWatchdog chip;
    Watchdog watchdog{chip.registers, chip.errors};
};

TEST(ZynqWatchdog, each_register_is_written_with_its_key) {
    chip.errors.enable_1 = 1U << 3U;
    watchdog.start(20'000, 100);
    UNSIGNED_LONGS_EQUAL(0xABC000U | 0x1C3U, chip.registers.mode);            // ZKEY, lengths, RSTEN, WDEN
    UNSIGNED_LONGS_EQUAL(0x248U << 14U | 60U << 2U, chip.registers.control);  // CKEY, CRV, clock / 8
    UNSIGNED_LONGS_EQUAL(0x1999, chip.registers.restart);
    UNSIGNED_LONGS_EQUAL(1U << 12U, chip.errors.system_reset_enable_1);
    UNSIGNED_LONGS_EQUAL(1U << 12U | 1U << 3U, chip.errors.enable_1);
    UNSIGNED_LONGS_EQUAL(0, chip.errors.status_1);
}

TEST(ZynqWatchdog, resets_when_its_time_is_over_and_not_before) {
    watchdog.start(20'000, 100);
    chip.pass(19'600);
    CHECK_FALSE(chip.has_reset);
    chip.pass(400);
    CHECK_TRUE(chip.has_reset);
}

TEST(ZynqWatchdog, does_not_reset_while_it_is_fed) {
    watchdog.start(20'000, 100);
    for (int k = 0; k < 100; ++k) {
        chip.pass(15'000);
        watchdog.feed();
    }
    CHECK_FALSE(chip.has_reset);
    chip.pass(20'000);
    CHECK_TRUE(chip.has_reset);
}

TEST(ZynqWatchdog, is_not_touched_before_its_start) {
    watchdog.feed();
    CHECK_FALSE(watchdog.is_started());
    UNSIGNED_LONGS_EQUAL(0, chip.registers.restart);
    watchdog.start(1, 100);
    CHECK_TRUE(watchdog.is_started());
}

TEST(ZynqWatchdog, times_beyond_its_range_end_at_it) {
    watchdog.start(0, 100);
    UNSIGNED_LONGS_EQUAL(0, chip.registers.control >> 2U & 0xFFFU);
    watchdog.start(1'342'177, 100);
    UNSIGNED_LONGS_EQUAL(0xFFE, chip.registers.control >> 2U & 0xFFFU);
    watchdog.start(1'342'178, 100);
    UNSIGNED_LONGS_EQUAL(0xFFF, chip.registers.control >> 2U & 0xFFFU);
    watchdog.start(UINT32_MAX, UINT32_MAX);
    UNSIGNED_LONGS_EQUAL(0xFFF, chip.registers.control >> 2U & 0xFFFU);
}

TEST_GROUP(ZynqReset){};

TEST(ZynqReset, each_reset_tells_its_cause_once) {
    struct Case {
        std::uint32_t flags;
        hal::ResetCause cause;
    };
    // A flag stays until it is cleared, and a boot loader need not have done so.
    const Case cases[] = {
        {0x01, hal::ResetCause::power_on}, {0x02, hal::ResetCause::unknown},  {0x04, hal::ResetCause::watchdog},
        {0x05, hal::ResetCause::watchdog}, {0x08, hal::ResetCause::software}, {0x10, hal::ResetCause::pin},
        {0x20, hal::ResetCause::software}, {0x40, hal::ResetCause::software}, {0x11, hal::ResetCause::pin},
        {0x00, hal::ResetCause::unknown},
    };
    for (const Case& c : cases) {
        Register reason = c.flags;
        LONGS_EQUAL(c.cause, take_reset_cause(reason));
        UNSIGNED_LONGS_EQUAL(c.flags, reason);  // written back: cleared by ones
    }
}
