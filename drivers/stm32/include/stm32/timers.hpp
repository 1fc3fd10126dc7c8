// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "stm32/registers.hpp"

/// Timers as a clock, as the converter's trigger, and as counters of encoders. RM0090 17.4, 18.4

namespace millforce::stm32 {

/// `timer` counts microseconds from 0 on; 32-bit timers (TIM2, TIM5) wrap after 71.6 minutes. `clock_hz`: whole MHz.
void start_microsecond_clock(TimerRegisters& timer, std::uint32_t clock_hz);
/// `timer` gives TRGO at `rate_hz`; clock_hz / rate_hz is 2…65536.
void start_trigger(TimerRegisters& timer, std::uint32_t clock_hz, std::uint32_t rate_hz);

struct EncoderSettings {
    bool is_32_bit = false;   ///< TIM2, TIM5
    bool reversed = false;    ///< counts against the direction that is wanted
    bool has_index = false;   ///< the index pulse is wired to channel 3, its rising edge counts
    std::uint8_t filter = 3;  ///< filter of the inputs, ICxF: 3 is eight equal samples of the timer's clock
};

struct EncoderReading {
    std::uint32_t count = 0;        ///< four per line of the encoder; wraps at 32 bits for every timer
    std::uint32_t index_count = 0;  ///< count at the last index pulse
    std::uint8_t index_number = 0;  ///< increases by one at each
};

/// A quadrature encoder on channels 1 and 2. read() at least every half turn of the timer's range, for 16-bit timers
/// every 32 767 counts; two index pulses between two read() are one, and counted as missed. No interrupt. One thread.
class Encoder {
  public:
    Encoder(TimerRegisters& timer, const EncoderSettings& settings) : timer_(timer), settings_(settings) {}

    void start();
    [[nodiscard]] EncoderReading read();
    [[nodiscard]] std::uint32_t missed_indexes() const { return missed_indexes_; }

  private:
    /// The 32-bit count of what the timer's register held just now or a little earlier.
    [[nodiscard]] std::uint32_t widened(std::uint32_t raw) const;

    TimerRegisters& timer_;
    EncoderSettings settings_;
    EncoderReading reading_{};
    std::uint32_t missed_indexes_ = 0;
};

}  // namespace millforce::stm32
