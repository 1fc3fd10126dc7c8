// SPDX-License-Identifier: Apache-2.0
// The controller on the first Cortex-R5F of a ZCU102, drives and CNC on its CAN 0: composition root.

#include <array>
#include <cstddef>
#include <span>

#include "common/processor.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware/ready_tools.hpp"
#include "zcu102/bus_controller.hpp"
#include "zynqmp/reset_cause.hpp"

extern "C" {
extern const std::uint8_t _parameters[];  // firmware/boards/zcu102/memory.ld
}

namespace {

using namespace millforce;

template <typename Registers>
Registers& at(std::uintptr_t address) {
    return *reinterpret_cast<Registers*>(address);
}

/// Of the processor's cycle counter: 500 on the chip; the emulator's counts its nanoseconds.
constexpr std::uint32_t cycles_per_us = MILLFORCE_CYCLES_PER_US;

/// PMCR, PMCNTENSET: Armv7-R Architecture Reference Manual C12
void start_cycle_counter() {
    constexpr std::uint32_t enable = 1;
    constexpr std::uint32_t cycle_counter = 1U << 31U;
    asm volatile("mcr p15, 0, %0, c9, c12, 0\n mcr p15, 0, %1, c9, c12, 1" : : "r"(enable), "r"(cycle_counter));
}

/// 64 bits out of the counter's 32; at least once in its round, 8 s on the chip.
std::uint64_t now_us() {
    static std::uint64_t us = 0;
    static std::uint32_t counted = 0;
    std::uint32_t cycles = 0;
    asm volatile("mrc p15, 0, %0, c9, c13, 0" : "=r"(cycles));
    const std::uint32_t elapsed_us = (cycles - counted) / cycles_per_us;
    us += elapsed_us;
    counted += elapsed_us * cycles_per_us;
    return us;
}

/// Silence: a CNC that hears nothing holds the feed. Where the watchdog runs it ends in a reset.
[[noreturn]] void stay_silent() {
    for (;;) {
        asm volatile("wfi");
    }
}

}  // namespace

void millforce::board::run_image() {
    start_cycle_counter();
    static firmware::Parameters<float> parameters;
    const std::span<const std::uint8_t> block(_parameters, firmware::largest_block_bytes);
    if (firmware::decode(block, parameters) != firmware::BlockError::none) {
        stay_silent();
    }
    const firmware::CanControllerSettings settings =
        firmware::can_controller_settings(parameters.machine, zcu102::bus_objects);
    if (cia402::check(settings.drives) != cia402::SettingsError::none) {
        stay_silent();
    }
    const firmware::BlockTools of_block = firmware::tools_of(block);
    static std::array<firmware::ReadyTool, firmware::largest_tool_count> memory;
    static firmware::ReadyTools tools(memory);
    tools.add(of_block, parameters);  // less than 0.1 s for each
    namespace address = zynqmp::address;
    static zcu102::BusController controller({.can = at<zynqmp::CanRegisters>(address::can0),
                                             .watchdog = at<zynqmp::WatchdogRegisters>(address::watchdog),
                                             .errors = at<zynqmp::ErrorRegisters>(address::errors)},
                                            settings, parameters, of_block.size() > 0 ? &tools : nullptr);
    controller.start(zynqmp::kbit_1000, zynqmp::take_reset_cause(at<zynqmp::Register>(address::reset_reason)));
    for (;;) {
        controller.poll(now_us());
        asm volatile("yield");  // an emulator of several processors on one goes on to the next
    }
}

void millforce::board::on_processor_fault(const FaultRecord&) {
    stay_silent();
}
