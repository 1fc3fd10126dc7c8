// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "stm32/registers.hpp"

/// Pins. RM0090 8.4

namespace millforce::stm32 {

enum class Pull : std::uint8_t { none = 0, up = 1, down = 2 };

/// The pin belongs to a peripheral, `function` 0…15 (data sheet, table 9). Push-pull, fast.
void set_alternate_function(GpioRegisters& port, unsigned pin, unsigned function, Pull pull = Pull::none);
/// The pin belongs to the converter.
void set_analogue(GpioRegisters& port, unsigned pin);

}  // namespace millforce::stm32
