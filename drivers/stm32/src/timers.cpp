// SPDX-License-Identifier: Apache-2.0
#include "stm32/timers.hpp"

namespace millforce::stm32 {

namespace {
constexpr std::uint32_t counter_enable = 1U << 0U;     // CR1
constexpr std::uint32_t update_generation = 1U << 0U;  // EGR
constexpr std::uint32_t trigger_on_update = 2U;        // CR2, MMS
constexpr std::uint32_t encoder_both_edges = 3U;       // SMCR, SMS
constexpr std::uint32_t input_is_direct = 1U;          // CCMRx, CCyS
constexpr std::uint32_t input_1_inverted = 1U << 1U;   // CCER
constexpr std::uint32_t capture_3_enable = 1U << 8U;   // CCER
constexpr std::uint32_t captured_3 = 1U << 3U;         // SR
constexpr std::uint32_t captured_3_again = 1U << 11U;  // SR
constexpr std::uint32_t whole_range = 0xFFFF'FFFFU;
}  // namespace

void start_microsecond_clock(TimerRegisters& timer, std::uint32_t clock_hz) {
    timer.psc = clock_hz / 1'000'000U - 1U;
    timer.arr = whole_range;
    timer.egr = update_generation;  // takes the prescaler over
    timer.cnt = 0;
    timer.cr1 = counter_enable;
}

void start_trigger(TimerRegisters& timer, std::uint32_t clock_hz, std::uint32_t rate_hz) {
    timer.psc = 0;
    timer.arr = clock_hz / rate_hz - 1U;
    set_field(timer.cr2, 4, 3, trigger_on_update);
    timer.egr = update_generation;
    timer.cr1 = counter_enable;
}

void Encoder::start() {
    const std::uint32_t input = input_is_direct | static_cast<std::uint32_t>(settings_.filter & 0xFU) << 4U;
    timer_.cr1 = 0;
    timer_.psc = 0;
    timer_.arr = settings_.is_32_bit ? whole_range : 0xFFFFU;
    timer_.ccmr1 = input | input << 8U;
    timer_.ccmr2 = settings_.has_index ? input : 0U;
    timer_.ccer = (settings_.reversed ? input_1_inverted : 0U) | (settings_.has_index ? capture_3_enable : 0U);
    timer_.smcr = encoder_both_edges;
    timer_.cnt = 0;
    timer_.sr = 0;
    timer_.cr1 = counter_enable;
}

std::uint32_t Encoder::widened(std::uint32_t raw) const {
    if (settings_.is_32_bit) {
        return raw;
    }
    const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(raw - reading_.count));
    return reading_.count + static_cast<std::uint32_t>(static_cast<std::int32_t>(step));
}

EncoderReading Encoder::read() {
    reading_.count = widened(timer_.cnt);
    const std::uint32_t status = timer_.sr;
    if (settings_.has_index && (status & captured_3) != 0) {
        // Writing a zero clears a flag; writing a one leaves flags that were set meanwhile.
        timer_.sr = ~(captured_3 | captured_3_again);
        reading_.index_count = widened(timer_.ccr[2]);
        reading_.index_number = static_cast<std::uint8_t>(reading_.index_number + 1U);
        missed_indexes_ += (status & captured_3_again) != 0 ? 1U : 0U;
    }
    return reading_;
}

}  // namespace millforce::stm32
