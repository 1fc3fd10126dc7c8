// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "parameters/tool_set.hpp"
#include "run_report/run_history.hpp"

/// Ticks as a controller of a tool with a limit of 700 N makes them.
namespace millforce::host::test {

inline ToolSet endmill() {
    const std::filesystem::path tools = std::filesystem::path(MILLFORCE_SOURCE_DIR) / "sim/scenarios/tools";
    return ToolSet({}, {(tools / "endmill_10mm.toml").string(), ""});
}

inline constexpr float tooth_force_limit_N = 700.0F;

inline firmware::TickRecord in_air() {
    firmware::TickRecord tick;
    tick.feed_override = {0.2F, false, static_cast<std::uint8_t>(control::CutState::air), 0, 1};
    tick.limit = static_cast<std::uint8_t>(control::Limit::air_feed);
    return tick;
}

/// With a known immersion.
inline firmware::TickRecord in_cut(float share_of_limit, control::Limit limit = control::Limit::force) {
    firmware::TickRecord tick;
    tick.feed_override = {0.5F, false, static_cast<std::uint8_t>(control::CutState::in_cut), 0, 1};
    tick.limit = static_cast<std::uint8_t>(limit);
    tick.radial_immersion = 0.6F;
    tick.radial_immersion_sd = 0.05F;
    tick.axial_depth_mm = 4.0F;
    tick.axial_depth_sd_mm = 0.4F;
    tick.tooth_force_N = share_of_limit * tooth_force_limit_N;
    return tick;
}

/// Without one: the load is an upper bound.
inline firmware::TickRecord entering(float share_of_limit) {
    firmware::TickRecord tick;
    tick.feed_override = {0.3F, false, static_cast<std::uint8_t>(control::CutState::entry), 0, 1};
    tick.limit = static_cast<std::uint8_t>(control::Limit::entry_feed);
    tick.tooth_force_N = share_of_limit * tooth_force_limit_N;
    return tick;
}

}  // namespace millforce::host::test
