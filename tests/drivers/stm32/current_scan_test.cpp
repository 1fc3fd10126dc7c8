// SPDX-License-Identifier: Apache-2.0
#include "stm32/current_scan.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::stm32;

namespace {
CurrentScanSettings four_currents() {
    CurrentScanSettings settings;
    for (std::uint8_t place = 0; place < scan_channels; ++place) {
        settings.channels[place] = {static_cast<std::uint8_t>(10 + place), 20.0F, 1.65F, 30.0F};
    }
    return settings;
}
constexpr std::uint32_t ring_values = CurrentScan::ring_scans * scan_channels;
constexpr std::uint16_t raw_zero = 2048;
}  // namespace

TEST_GROUP(Stm32CurrentScan) {
    AdcRegisters adc{};
    AdcCommonRegisters common{};
    DmaRegisters dma{};
    CurrentScan scan{adc, common, dma, four_currents()};

    void setup() override {
        scan.start();
    }
    /// What converter and DMA do.
    void convert(std::uint16_t a, std::uint16_t b, std::uint16_t c, std::uint16_t d) {
        for (const std::uint16_t raw : {a, b, c, d}) {
            scan.ring()[ring_values - dma.stream[0].ndtr] = raw;
            const std::uint32_t left = dma.stream[0].ndtr - 1U;
            dma.stream[0].ndtr = left == 0 ? ring_values : left;
        }
    }
};

TEST(Stm32CurrentScan, four_inputs_in_order_by_the_trigger_into_a_ring) {
    UNSIGNED_LONGS_EQUAL(1U << 16U, common.ccr);                                // ADCPRE: a quarter
    UNSIGNED_LONGS_EQUAL(1U << 8U, adc.cr1);                                    // SCAN
    UNSIGNED_LONGS_EQUAL(3U << 20U, adc.sqr1);                                  // L
    UNSIGNED_LONGS_EQUAL(10U | 11U << 5U | 12U << 10U | 13U << 15U, adc.sqr3);  // SQ1…4
    UNSIGNED_LONGS_EQUAL(4U | 4U << 3U | 4U << 6U | 4U << 9U, adc.smpr1);       // SMP10…13
    UNSIGNED_LONGS_EQUAL(0x1E00'0301U, adc.cr2);  // EXTEN rising, EXTSEL TIM8 TRGO, DDS, DMA, ADON
    const DmaStreamRegisters& stream = dma.stream[0];
    UNSIGNED_LONGS_EQUAL(128, stream.ndtr);
    UNSIGNED_LONGS_EQUAL(0x0002'2D01U, stream.cr);  // PL high, MSIZE, PSIZE 16, MINC, CIRC, EN
    UNSIGNED_LONGS_EQUAL(static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&adc.dr)), stream.par);
    UNSIGNED_LONGS_EQUAL(static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(scan.ring().data())), stream.m0ar);
    UNSIGNED_LONGS_EQUAL(0x3D, dma.lifcr);
}

TEST(Stm32CurrentScan, inputs_below_10_have_their_times_in_the_other_register) {
    CurrentScanSettings settings = four_currents();
    settings.channels[0].input = 9;
    AdcRegisters other{};
    CurrentScan(other, common, dma, settings).start();
    UNSIGNED_LONGS_EQUAL(4U << 27U, other.smpr2);
    UNSIGNED_LONGS_EQUAL(4U << 3U | 4U << 6U | 4U << 9U, other.smpr1);
}

TEST(Stm32CurrentScan, gives_the_mean_of_what_came_since_the_last_time) {
    convert(raw_zero, 2148, 1948, 2548);
    convert(raw_zero, 2248, 1848, 2548);
    const ScanReading reading = scan.take();
    UNSIGNED_LONGS_EQUAL(2, reading.scans);
    DOUBLES_EQUAL(0.0, reading.current_A[0], 1e-5);
    DOUBLES_EQUAL(150 * 3.3 / 4096 * 20, reading.current_A[1], 1e-4);
    DOUBLES_EQUAL(-150 * 3.3 / 4096 * 20, reading.current_A[2], 1e-4);
    DOUBLES_EQUAL(500 * 3.3 / 4096 * 20, reading.current_A[3], 1e-4);
    CHECK_TRUE(reading.has[0] && reading.has[1] && reading.has[2] && reading.has[3]);
}

TEST(Stm32CurrentScan, has_nothing_where_nothing_came_nor_of_a_scan_in_work) {
    UNSIGNED_LONGS_EQUAL(0, scan.take().scans);
    dma.stream[0].ndtr = ring_values - 3;
    const ScanReading reading = scan.take();
    UNSIGNED_LONGS_EQUAL(0, reading.scans);
    CHECK_FALSE(reading.has[0] || reading.has[1] || reading.has[2] || reading.has[3]);
}

TEST(Stm32CurrentScan, goes_round_the_ring_without_losing_or_repeating_a_scan) {
    std::uint32_t scans = 0;
    for (unsigned take = 0; take < 50; ++take) {
        const unsigned fresh = 1 + take % 31;
        const auto raw = static_cast<std::uint16_t>(1500 + take);
        for (unsigned k = 0; k < fresh; ++k) {
            convert(raw, raw, raw, raw);
        }
        const ScanReading reading = scan.take();
        UNSIGNED_LONGS_EQUAL(fresh, reading.scans);
        DOUBLES_EQUAL(20.0 * (raw * 3.3 / 4096 - 1.65), reading.current_A[3], 2e-4);
        scans += reading.scans;
    }
    CHECK_TRUE(scans > 10 * CurrentScan::ring_scans);
}

TEST(Stm32CurrentScan, a_value_at_the_rail_is_no_current) {
    convert(0, 4095, raw_zero, raw_zero);
    convert(0, 2148, raw_zero, raw_zero);
    const ScanReading reading = scan.take();
    CHECK_FALSE(reading.has[0]);
    CHECK_TRUE(reading.has[1]);
    DOUBLES_EQUAL(100 * 3.3 / 4096 * 20, reading.current_A[1], 1e-4);
    UNSIGNED_LONGS_EQUAL(3, scan.health().at_rail);
}

TEST(Stm32CurrentScan, a_current_beyond_its_limit_is_not_used) {
    convert(4090, raw_zero, raw_zero, raw_zero);
    const ScanReading reading = scan.take();
    CHECK_FALSE(reading.has[0]);
    CHECK_EQUAL(0.0F, reading.current_A[0]);
    UNSIGNED_LONGS_EQUAL(1, scan.health().beyond_limit);
}

TEST(Stm32CurrentScan, starts_anew_after_an_overrun_and_after_a_DMA_error) {
    convert(1000, 1000, 1000, 1000);
    adc.sr = 1U << 5U;  // OVR
    UNSIGNED_LONGS_EQUAL(0, scan.take().scans);
    UNSIGNED_LONGS_EQUAL(1, scan.health().restarts);
    UNSIGNED_LONGS_EQUAL(0, adc.sr);
    UNSIGNED_LONGS_EQUAL(128, dma.stream[0].ndtr);
    UNSIGNED_LONGS_EQUAL(0x1E00'0301U, adc.cr2);
    dma.lisr = 1U << 3U;  // TEIF0
    UNSIGNED_LONGS_EQUAL(0, scan.take().scans);
    UNSIGNED_LONGS_EQUAL(2, scan.health().restarts);
    dma.lisr = 0;
    convert(raw_zero, raw_zero, raw_zero, raw_zero);
    UNSIGNED_LONGS_EQUAL(1, scan.take().scans);
}
