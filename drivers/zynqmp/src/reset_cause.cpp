// SPDX-License-Identifier: Apache-2.0
#include "zynqmp/reset_cause.hpp"

namespace millforce::zynqmp {

namespace {
constexpr std::uint32_t external_power_on = 1U << 0U;
constexpr std::uint32_t internal_power_on = 1U << 1U;
constexpr std::uint32_t system_error = 1U << 2U;
constexpr std::uint32_t reset_pin = 1U << 4U;
constexpr std::uint32_t by_software = 1U << 3U | 1U << 5U | 1U << 6U;  // processing system only, whole, debugger
}  // namespace

hal::ResetCause take_reset_cause(Register& reset_reason) {
    const std::uint32_t flags = reset_reason;
    reset_reason = flags;  // cleared by ones
    const auto has = [flags](std::uint32_t bits) { return (flags & bits) != 0; };
    if (has(system_error)) {
        return hal::ResetCause::watchdog;
    }
    if (has(internal_power_on)) {
        return hal::ResetCause::unknown;
    }
    if (has(by_software)) {
        return hal::ResetCause::software;
    }
    if (has(reset_pin)) {
        return hal::ResetCause::pin;
    }
    return has(external_power_on) ? hal::ResetCause::power_on : hal::ResetCause::unknown;
}

}  // namespace millforce::zynqmp
