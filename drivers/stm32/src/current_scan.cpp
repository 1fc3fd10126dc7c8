// SPDX-License-Identifier: Apache-2.0
#include "stm32/current_scan.hpp"

namespace millforce::stm32 {

namespace {

// ADC_SR, CR1, CR2
constexpr std::uint32_t overrun = 1U << 5U;
constexpr std::uint32_t scan_mode = 1U << 8U;
constexpr std::uint32_t converter_on = 1U << 0U;
constexpr std::uint32_t use_dma = 1U << 8U;
constexpr std::uint32_t dma_goes_on = 1U << 9U;  // DDS: requests after the ring's end, too
constexpr std::uint32_t trigger_tim8 = 14U << 24U;
constexpr std::uint32_t rising_edge = 1U << 28U;
constexpr std::uint32_t sample_84_cycles = 4U;

// DMA, stream 0
constexpr std::uint32_t stream_enable = 1U << 0U;
constexpr std::uint32_t circular = 1U << 8U;
constexpr std::uint32_t memory_increments = 1U << 10U;
constexpr std::uint32_t peripheral_16_bit = 1U << 11U;
constexpr std::uint32_t memory_16_bit = 1U << 13U;
constexpr std::uint32_t high_priority = 2U << 16U;
constexpr std::uint32_t stream_0_flags = 0x3DU;
constexpr std::uint32_t stream_0_error = 1U << 3U;

constexpr std::uint16_t highest_raw = 4095;
constexpr float raw_values = 4096.0F;

std::uint32_t bus_address(const volatile void* pointer) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(pointer));
}

}  // namespace

void CurrentScan::start() {
    constexpr std::uint32_t clock_divided_by_4 = 1U;
    set_field(common_.ccr, 16, 2, clock_divided_by_4);  // 21 MHz of 84
    adc_.cr2 = 0;
    adc_.cr1 = scan_mode;
    adc_.sqr1 = (scan_channels - 1U) << 20U;
    for (unsigned place = 0; place < scan_channels; ++place) {
        const unsigned input = settings_.channels[place].input;
        set_field(adc_.sqr3, 5U * place, 5, input);
        if (input < 10U) {
            set_field(adc_.smpr2, 3U * input, 3, sample_84_cycles);
        } else {
            set_field(adc_.smpr1, 3U * (input - 10U), 3, sample_84_cycles);
        }
    }
    start_dma();
    start_converter();
}

void CurrentScan::start_dma() {
    DmaStreamRegisters& stream = dma_.stream[0];
    stream.cr = 0;
    dma_.lifcr = stream_0_flags;
    stream.par = bus_address(&adc_.dr);
    stream.m0ar = bus_address(ring_.data());
    stream.ndtr = static_cast<std::uint32_t>(ring_.size());
    stream.fcr = 0;
    stream.cr = circular | memory_increments | peripheral_16_bit | memory_16_bit | high_priority;
    set_bits(stream.cr, stream_enable);
    next_scan_ = 0;
}

void CurrentScan::start_converter() {
    adc_.sr = 0;
    adc_.cr2 = converter_on | use_dma | dma_goes_on | trigger_tim8 | rising_edge;
}

bool CurrentScan::failed() const {
    return has_bits(adc_.sr, overrun) || has_bits(dma_.lisr, stream_0_error);
}

std::size_t CurrentScan::scan_in_work() const {
    const std::size_t left = dma_.stream[0].ndtr;
    return left > ring_.size() ? next_scan_ : (ring_.size() - left) / scan_channels % ring_scans;
}

void CurrentScan::add_scan(std::size_t scan, std::array<std::uint32_t, scan_channels>& sums,
                           std::array<std::uint32_t, scan_channels>& counts) {
    for (std::size_t place = 0; place < scan_channels; ++place) {
        const std::uint16_t raw = ring_[scan * scan_channels + place];
        if (raw == 0 || raw >= highest_raw) {
            ++health_.at_rail;
            continue;
        }
        sums[place] += raw;
        ++counts[place];
    }
}

float CurrentScan::volts(std::uint32_t sum, std::uint32_t count) const {
    return settings_.reference_V / raw_values * static_cast<float>(sum) / static_cast<float>(count);
}

ScanReading CurrentScan::take() {
    ScanReading reading;
    if (failed()) {
        // After an overrun the values are shifted to other channels: all of them are discarded.
        ++health_.restarts;
        adc_.cr2 = 0;
        start_dma();
        start_converter();
        return reading;
    }
    std::array<std::uint32_t, scan_channels> sums{};
    std::array<std::uint32_t, scan_channels> counts{};
    const std::size_t end = scan_in_work();
    for (; next_scan_ != end; next_scan_ = (next_scan_ + 1U) % ring_scans) {
        add_scan(next_scan_, sums, counts);
        ++reading.scans;
    }
    for (std::size_t place = 0; place < scan_channels; ++place) {
        const CurrentChannel& channel = settings_.channels[place];
        if (counts[place] == 0 || channel.A_per_V == 0.0F) {
            continue;
        }
        const float current_A = channel.A_per_V * (volts(sums[place], counts[place]) - channel.zero_V);
        const bool is_possible = current_A < channel.largest_A && current_A > -channel.largest_A;
        reading.has[place] = is_possible;
        reading.current_A[place] = is_possible ? current_A : 0.0F;
        health_.beyond_limit += is_possible ? 0U : 1U;
    }
    return reading;
}

}  // namespace millforce::stm32
