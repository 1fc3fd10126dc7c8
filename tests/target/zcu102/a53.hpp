// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// What programs of the zcu102's Cortex-A53 have in place of a C library.

extern "C" {
/// The raw call; its meaning depends on `operation`.
long semihosting(long operation, const void* argument);
/// 0: the processor runs from this address.
long start_processor(long processor, std::uintptr_t address);
/// Given by the program.
void run();
}

namespace millforce::target {

/// The first Cortex-R5F, and where its image begins: with the vector of its reset.
inline constexpr long cortex_r5f = 4;
inline constexpr std::uintptr_t image_of_r5f = 0;

[[noreturn]] inline void exit_emulator(long code) {
    constexpr long exit_operation = 0x18;
    constexpr long application_exit = 0x20026;
    const long block[] = {application_exit, code};
    semihosting(exit_operation, block);
    for (;;) {
    }
}

}  // namespace millforce::target
