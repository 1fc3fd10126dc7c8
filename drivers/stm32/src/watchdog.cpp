// SPDX-License-Identifier: Apache-2.0
#include "stm32/watchdog.hpp"

namespace millforce::stm32 {

namespace {
constexpr std::uint32_t key_reload = 0xAAAA;
constexpr std::uint32_t key_access = 0x5555;
constexpr std::uint32_t key_start = 0xCCCC;
constexpr std::uint32_t divide_by_4 = 0;
constexpr std::uint32_t us_per_count = 125;  // 32 kHz / 4
constexpr std::uint32_t largest_reload = 0xFFF;
}  // namespace

void Watchdog::start(std::uint32_t timeout_us) {
    const std::uint32_t counts = timeout_us / us_per_count;
    const std::uint32_t reload = counts == 0 ? 0 : counts - 1U;
    // The start also starts its oscillator; the two settings reach it a few of its periods later.
    registers_.kr = key_start;
    registers_.kr = key_access;
    registers_.pr = divide_by_4;
    registers_.rlr = reload < largest_reload ? reload : largest_reload;
    started_ = true;
}

void Watchdog::feed() {
    if (started_) {
        registers_.kr = key_reload;
    }
}

}  // namespace millforce::stm32
