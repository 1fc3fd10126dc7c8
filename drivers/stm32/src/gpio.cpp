// SPDX-License-Identifier: Apache-2.0
#include "stm32/gpio.hpp"

namespace millforce::stm32 {

namespace {
constexpr std::uint32_t mode_alternate = 2;
constexpr std::uint32_t mode_analogue = 3;
constexpr std::uint32_t fast = 2;
}  // namespace

void set_alternate_function(GpioRegisters& port, unsigned pin, unsigned function, Pull pull) {
    // The function first: the pin must not drive another one for a moment.
    set_field(port.afr[pin / 8U], 4U * (pin % 8U), 4, function);
    clear_bits(port.otyper, 1U << pin);
    set_field(port.ospeedr, 2U * pin, 2, fast);
    set_field(port.pupdr, 2U * pin, 2, static_cast<std::uint32_t>(pull));
    set_field(port.moder, 2U * pin, 2, mode_alternate);
}

void set_analogue(GpioRegisters& port, unsigned pin) {
    set_field(port.pupdr, 2U * pin, 2, 0);
    set_field(port.moder, 2U * pin, 2, mode_analogue);
}

}  // namespace millforce::stm32
