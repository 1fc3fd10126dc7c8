// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "target/zcu102_plant/emulated_time.hpp"

namespace millforce::target {

/// From now on the program is interrupted by the virtual timer after each `turn_us` to let the other processor go on,
/// which stands meanwhile in an emulator that runs them by turns: start.S. GIC: Arm IHI 0048, at the addresses of
/// UG1085.
inline void take_turns(std::uint64_t turn_us) {
    constexpr std::uintptr_t distributor = 0xF901'0000;
    constexpr std::uintptr_t processor_interface = 0xF902'0000;
    constexpr std::uint32_t virtual_timer = 1U << 27U;
    const auto set = [](std::uintptr_t address, std::uint32_t value) {
        *reinterpret_cast<volatile std::uint32_t*>(address) = value;
    };
    set(distributor + 0x000, 1);              // GICD_CTLR
    set(distributor + 0x100, virtual_timer);  // GICD_ISENABLER0
    set(processor_interface + 0x004, 0xFF);   // GICC_PMR: all priorities
    set(processor_interface + 0x000, 1);      // GICC_CTLR
    const std::uint64_t ticks = turn_us * timer_counts_per_ms() / 1000U;
    asm volatile("msr tpidr_el1, %0\n msr cntv_tval_el0, %0\n msr cntv_ctl_el0, %1\n isb\n msr daifclr, #2"
                 :
                 : "r"(ticks), "r"(std::uint64_t{1})
                 : "memory");
}

}  // namespace millforce::target
