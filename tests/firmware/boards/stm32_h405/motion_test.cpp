// SPDX-License-Identifier: Apache-2.0
#include "stm32_h405/motion.hpp"

#include "stm32_h405/wiring.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::stm32_h405;

TEST_GROUP(AxisVelocity){};

TEST(AxisVelocity, is_the_mean_over_eight_periods_in_both_directions_across_the_wrap) {
    AxisVelocity velocity;
    CHECK_EQUAL(0.0F, velocity.update(0xFFFF'FFF0U, 0xFFFF'F000U, 0.001F));
    float v_mm_s = 0.0F;
    for (unsigned k = 1; k <= 20; ++k) {
        v_mm_s = velocity.update(0xFFFF'FFF0U + 20U * k, 0xFFFF'F000U + 1000U * k, 0.001F);
        DOUBLES_EQUAL(20.0, v_mm_s, 1e-4);
    }
    for (unsigned k = 1; k <= 8; ++k) {
        v_mm_s = velocity.update(0xFFFF'FFF0U + 400U - 10U * k, 0xFFFF'F000U + 20'000U + 1000U * k, 0.001F);
    }
    DOUBLES_EQUAL(-10.0, v_mm_s, 1e-4);
}

TEST(AxisVelocity, one_count_in_eight_periods_is_an_eighth_of_a_count_per_period) {
    AxisVelocity velocity;
    for (unsigned k = 0; k < 9; ++k) {
        (void)velocity.update(0, 1000U * k, 0.001F);
    }
    DOUBLES_EQUAL(0.125, velocity.update(1, 9000, 0.001F), 1e-6);
}

TEST_GROUP(EncoderWatch) {
    EncoderWatch watch{4096};
    std::uint32_t count = 0;
    std::uint8_t number = 0;
    bool turn(std::uint32_t counts) {
        count += counts;
        return watch.is_plausible(count, count, ++number);
    }
};

TEST(EncoderWatch, whole_revolutions_are_plausible_in_both_directions) {
    CHECK_TRUE(turn(1000));
    CHECK_TRUE(turn(4096));
    CHECK_TRUE(turn(2 * 4096 + 3));
    CHECK_TRUE(turn(0U - 4096U - 2U));
    CHECK_TRUE(turn(40));  // to and fro over the pulse
}

TEST(EncoderWatch, lost_counts_are_not_until_two_good_revolutions) {
    CHECK_TRUE(turn(4096));
    CHECK_FALSE(turn(3900));
    CHECK_FALSE(turn(4096));
    CHECK_TRUE(turn(4096));
}

TEST(EncoderWatch, an_index_that_stays_away_is_found_after_two_revolutions) {
    CHECK_TRUE(turn(4096));
    CHECK_TRUE(watch.is_plausible(count + 2 * 4096, count, number));
    CHECK_FALSE(watch.is_plausible(count + 2 * 4096 + 100, count, number));
    CHECK_FALSE(watch.is_plausible(count - 2 * 4096 - 100, count, number));
}

TEST_GROUP(Wiring){};

TEST(Wiring, each_pin_has_its_function_and_each_peripheral_its_clock) {
    stm32::GpioRegisters a{}, b{}, c{};
    connect_pins(a, b, c);
    UNSIGNED_LONGS_EQUAL(2U << 10U | 2U << 16U | 2U << 18U, a.moder);
    UNSIGNED_LONGS_EQUAL(1U << 20U, a.afr[0]);
    UNSIGNED_LONGS_EQUAL(0x11, a.afr[1]);
    UNSIGNED_LONGS_EQUAL(2U << 6U | 2U << 12U | 2U << 14U | 2U << 16U | 2U << 18U | 2U << 20U, b.moder);
    UNSIGNED_LONGS_EQUAL(0x2200'1000U, b.afr[0]);
    UNSIGNED_LONGS_EQUAL(0x199, b.afr[1]);
    UNSIGNED_LONGS_EQUAL(0xFFU | 2U << 12U | 2U << 14U, c.moder);
    UNSIGNED_LONGS_EQUAL(0x2200'0000U, c.afr[0]);
    stm32::RccRegisters rcc{};
    enable_peripherals(rcc);
    UNSIGNED_LONGS_EQUAL(0x0040'0007, rcc.ahb1enr);
    UNSIGNED_LONGS_EQUAL(0x1200'000F, rcc.apb1enr);
    UNSIGNED_LONGS_EQUAL(0x103, rcc.apb2enr);
}
