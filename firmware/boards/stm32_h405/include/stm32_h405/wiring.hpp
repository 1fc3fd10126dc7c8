// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "firmware_can/bus_settings.hpp"
#include "hal/drive_sample.hpp"
#include "override_frame/override_sender.hpp"
#include "program_status/program_status_receiver.hpp"
#include "stm32/can_controller.hpp"
#include "stm32/current_scan.hpp"
#include "stm32/registers.hpp"

/// What is connected to the board's pins, and what it measures. For another sensor or scale, change the values here.
///
/// | pin | what | peripheral |
/// |---|---|---|
/// | PC0, PC1, PC2, PC3 | currents of spindle, x, y, z, 0…3.3 V | ADC1 inputs 10…13 |
/// | PA5, PB3, PB10 | spindle encoder A, B, index | TIM2 channels 1, 2, 3 |
/// | PC6, PC7 | encoder of x, A and B | TIM3 |
/// | PB6, PB7 | encoder of y | TIM4 |
/// | PA8, PA9 | encoder of z | TIM1 |
/// | PB8, PB9 | CAN RX, TX, to a transceiver | CAN1 |

namespace millforce::stm32_h405 {

struct AxisWiring {
    float mm_per_count = 0.001F;  ///< four counts per line of the encoder
    bool reversed = false;
};

struct Wiring {
    stm32::CurrentScanSettings currents{{{{.input = 10, .A_per_V = 20.0F, .largest_A = 100.0F},
                                          {.input = 11, .A_per_V = 10.0F, .largest_A = 100.0F},
                                          {.input = 12, .A_per_V = 10.0F, .largest_A = 100.0F},
                                          {.input = 13, .A_per_V = 10.0F, .largest_A = 100.0F}}},
                                        3.3F};
    std::array<AxisWiring, hal::axis_count> axes{};
    bool spindle_reversed = false;
    bool has_index = true;
    stm32::CanBitRate bit_rate = stm32::CanBitRate::kbit_500;
    override_frame::OverrideSenderSettings feed_override = firmware::override_sender_settings({});
    program_status::ProgramStatusReceiverSettings program = firmware::program_status_settings({});
    std::uint32_t watchdog_us = 20'000;
    /// In place of it where the block has tools by number: longer than a change of the tool at the watchdog's fastest
    /// clock. The CNC stops the feed after 20 ms of silence by itself.
    std::uint32_t watchdog_with_tools_us = 400'000;
};

inline constexpr std::uint32_t crystal_hz = 8'000'000;
inline constexpr std::uint32_t scan_rate_hz = 8'000;

/// The chip's registers, or a test's.
struct Peripherals {
    stm32::TimerRegisters& spindle_timer;
    std::array<stm32::TimerRegisters*, hal::axis_count> axis_timers;
    stm32::AdcRegisters& adc;
    stm32::AdcCommonRegisters& adc_common;
    stm32::DmaRegisters& dma;
    stm32::CanRegisters& can;
    stm32::WatchdogRegisters& watchdog;
    stm32::PwrRegisters& pwr;
};

/// Clocks of what the table above names.
void enable_peripherals(stm32::RccRegisters& rcc);
void connect_pins(stm32::GpioRegisters& a, stm32::GpioRegisters& b, stm32::GpioRegisters& c);

}  // namespace millforce::stm32_h405
