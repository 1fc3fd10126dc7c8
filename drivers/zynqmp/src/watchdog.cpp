// SPDX-License-Identifier: Apache-2.0
#include "zynqmp/watchdog.hpp"

#include <algorithm>

namespace millforce::zynqmp {

namespace {
// A write without its key does nothing.
constexpr std::uint32_t mode_key = 0xABCU << 12U;
constexpr std::uint32_t control_key = 0x248U << 14U;
constexpr std::uint32_t restart_key = 0x1999;
// MODE
constexpr std::uint32_t enable = 1U << 0U;
constexpr std::uint32_t reset_at_zero = 1U << 1U;
constexpr std::uint32_t pulse_lengths = 0x1C0;  // as after a reset
// CONTROL; its lowest bits, 0, divide the clock by 8
constexpr unsigned restart_value_position = 2;
constexpr std::uint64_t counts_per_step = 4096;
constexpr std::uint64_t clock_divider = 8;
constexpr std::uint64_t most_steps = 4096;
// PMU_GLOBAL
constexpr std::uint32_t watchdog_error = 1U << 12U;
}  // namespace

void Watchdog::start(std::uint32_t timeout_us, std::uint32_t clock_MHz) {
    const std::uint64_t steps = std::uint64_t{timeout_us} * clock_MHz / (clock_divider * counts_per_step);
    const auto restart_value = static_cast<std::uint32_t>(std::clamp(steps, std::uint64_t{1}, most_steps) - 1U);
    registers_.mode = mode_key | pulse_lengths;
    registers_.control = control_key | restart_value << restart_value_position;
    registers_.restart = restart_key;
    errors_.system_reset_enable_1 = watchdog_error;  // zeros change nothing there
    errors_.enable_1 = errors_.enable_1 | watchdog_error;
    registers_.mode = mode_key | pulse_lengths | reset_at_zero | enable;
    started_ = true;
}

void Watchdog::feed() {
    if (started_) {
        registers_.restart = restart_key;
    }
}

}  // namespace millforce::zynqmp
