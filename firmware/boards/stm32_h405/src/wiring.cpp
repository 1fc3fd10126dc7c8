// SPDX-License-Identifier: Apache-2.0
#include "stm32_h405/wiring.hpp"

#include "stm32/gpio.hpp"

namespace millforce::stm32_h405 {

void enable_peripherals(stm32::RccRegisters& rcc) {
    constexpr std::uint32_t ports_a_b_c_and_dma2 = 7U | 1U << 22U;
    constexpr std::uint32_t tim2_to_tim5_can1_and_pwr = 0xFU | 1U << 25U | 1U << 28U;
    constexpr std::uint32_t tim1_tim8_and_adc1 = 3U | 1U << 8U;
    stm32::set_bits(rcc.ahb1enr, ports_a_b_c_and_dma2);
    stm32::set_bits(rcc.apb1enr, tim2_to_tim5_can1_and_pwr);
    stm32::set_bits(rcc.apb2enr, tim1_tim8_and_adc1);
    // A peripheral answers two clocks after its enable: reading the last one back takes as long.
    (void)static_cast<std::uint32_t>(rcc.apb2enr);
}

void connect_pins(stm32::GpioRegisters& a, stm32::GpioRegisters& b, stm32::GpioRegisters& c) {
    using stm32::Pull;
    constexpr unsigned tim1_tim2 = 1;
    constexpr unsigned tim3_to_tim5 = 2;
    constexpr unsigned can = 9;
    for (unsigned pin = 0; pin < 4U; ++pin) {
        stm32::set_analogue(c, pin);
    }
    // Pulled up: an encoder with a broken wire shows a constant count.
    stm32::set_alternate_function(a, 5, tim1_tim2, Pull::up);
    stm32::set_alternate_function(b, 3, tim1_tim2, Pull::up);
    stm32::set_alternate_function(b, 10, tim1_tim2, Pull::down);
    stm32::set_alternate_function(c, 6, tim3_to_tim5, Pull::up);
    stm32::set_alternate_function(c, 7, tim3_to_tim5, Pull::up);
    stm32::set_alternate_function(b, 6, tim3_to_tim5, Pull::up);
    stm32::set_alternate_function(b, 7, tim3_to_tim5, Pull::up);
    stm32::set_alternate_function(a, 8, tim1_tim2, Pull::up);
    stm32::set_alternate_function(a, 9, tim1_tim2, Pull::up);
    // Recessive without a transceiver.
    stm32::set_alternate_function(b, 8, can, Pull::up);
    stm32::set_alternate_function(b, 9, can);
}

}  // namespace millforce::stm32_h405
