// SPDX-License-Identifier: Apache-2.0
#include "run_log/estimate_entry.hpp"

#include <bit>

namespace millforce::host {

/// FNV-1a (64 bit) on words.
void TickEntries::mix(std::uint32_t high, std::uint32_t low) {
    constexpr std::uint64_t prime = 0x100'0000'01B3;
    digest_ = (digest_ ^ ((std::uint64_t{high} << 32U) | low)) * prime;
    digest_ ^= digest_ >> 32U;
}

bool TickEntries::add(const firmware::TickRecord& tick, std::uint32_t tool, EstimateEntry& entry) {
    constexpr std::uint64_t basis = 0xCBF2'9CE4'8422'2325;
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    const hal::FeedOverride& out = tick.feed_override;
    if (out.heartbeat <= 1) {
        digest_ = basis;
        next_us_ = 0;
    }
    mix(out.heartbeat, bits(out.ratio));
    mix(tick.limit, (std::uint32_t{out.state} << 16U) | (std::uint32_t{out.fault} << 8U) | (out.hold ? 1U : 0U));
    mix(bits(tick.tangential_force_N), bits(tick.feed_force_N));
    mix(bits(tick.radial_immersion), bits(tick.radial_immersion_sd));
    mix(bits(tick.axial_depth_mm), bits(tick.axial_depth_sd_mm));
    mix(bits(tick.tooth_force_N), bits(tick.total_force.tooth_force_N));
    mix(bits(tick.total_force.radial_immersion), bits(tick.total_force.axial_depth_mm));
    mix(bits(tick.runout_um), static_cast<std::uint32_t>(tick.total_force.side));
    if (tick.time_us < next_us_) {
        return false;
    }
    next_us_ = tick.time_us + interval_us_;
    entry = {digest_, tick, tool};
    return true;
}

}  // namespace millforce::host
