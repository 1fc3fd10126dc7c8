// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::target {

/// So many of the emulator's nanoseconds, each an instruction, are taken for a microsecond: toolchains/cmake.
inline constexpr std::uint64_t emulated_ns_per_us = MILLFORCE_EMULATED_NS_PER_US;

/// Counts of the generic timer in a millisecond of this board's time: Arm Architecture Reference Manual D11
inline std::uint64_t timer_counts_per_ms() {
    std::uint64_t frequency_hz = 0;
    asm volatile("mrs %0, cntfrq_el0" : "=r"(frequency_hz));
    return frequency_hz * emulated_ns_per_us / 1'000'000U;
}

}  // namespace millforce::target
