// SPDX-License-Identifier: Apache-2.0
#include "daemon/estimate_entry.hpp"

#include <bit>

#include "loop/override_source.hpp"

namespace millforce::host {

/// FNV-1a (64 bit) on words.
void TickEntries::mix(std::uint64_t bits) {
    constexpr std::uint64_t prime = 0x100'0000'01B3;
    digest_ = (digest_ ^ bits) * prime;
    digest_ ^= digest_ >> 32U;
}

bool TickEntries::add(const firmware::CanController& controller, EstimateEntry& entry) {
    constexpr std::uint64_t basis = 0xCBF2'9CE4'8422'2325;
    const hal::FeedOverride& out = controller.output();
    if (controller.ticks() <= 1) {
        digest_ = basis;
        next_us_ = 0;
    }
    sim::TracePoint point;
    sim::describe_tick(controller.controller(), point);
    mix((std::uint64_t{out.heartbeat} << 32U) | std::bit_cast<std::uint32_t>(out.ratio));
    mix((std::uint64_t{out.state} << 16U) | (std::uint64_t{out.fault} << 8U) | (out.hold ? 1U : 0U));
    for (const double value : {point.tangential_force_N, point.feed_force_N, point.radial_immersion,
                               point.radial_immersion_sd, point.axial_depth_mm, point.axial_depth_sd_mm,
                               point.tooth_force_N, point.peak_force_N, point.force_limit_N}) {
        mix(value == value ? std::bit_cast<std::uint64_t>(value) : 0U);
    }
    if (controller.tick_time_us() < next_us_) {
        return false;
    }
    next_us_ = controller.tick_time_us() + interval_us_;
    entry = {controller.tick_time_us(), digest_, point, out.ratio, out.hold};
    return true;
}

}  // namespace millforce::host
