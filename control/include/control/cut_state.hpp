// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace millforce::control {

/// Where the tool is in relation to the cut, as far as the forces tell. Each line says how the state is entered and
/// how it is left.
enum class CutState : std::uint8_t {
    air = 0,  ///< start; from `exit` after the exit travel without contact or a sharp turn. Left by contact → entry.
    entry = 1,   ///< contact, from air, exit or hold. Left after entry revolutions and travel → in_cut, or → exit.
    in_cut = 2,  ///< a full window of cutting is behind. Left by lost contact → exit, no estimate for long → hold.
    exit = 3,  ///< contact lost. Left by contact → entry (if it had cut: at that feed), by the exit travel or a turn →
               ///< air.
    hold = 4,   ///< nothing to judge by, or the feed is held: the override is not raised. Left when estimates return.
    fault = 5,  ///< latched. Left only by reset(), at standstill.
};

/// Why the controller has given up. Latched; every fault ends at the minimum override with the feed held.
enum class Fault : std::uint8_t {
    none = 0,
    overload = 1,         ///< the tooth's force stood above the stop level: the feed is held before the tooth breaks
    stale_input = 2,      ///< no drive sample within the time limit
    spindle_stopped = 3,  ///< the spindle stopped turning while the tool was in cut
    bad_configuration = 4,
};

/// Which limit holds the override down at this moment. Not a fault: a reason to show.
enum class Limit : std::uint8_t {
    none = 0,
    force = 1,  ///< the tooth's force is at its set point
    override_max = 2,
    override_min = 3,
    air_feed = 4,
    entry_feed = 5,
    surge = 6,  ///< an engagement may come that the controller could not follow
    operator_limit = 7,
    no_estimate = 8,  ///< held where it was for want of an estimate
    feed_per_tooth = 9,
    roughness = 10,  ///< the upper bound of the predicted R_a is at its limit
};

inline constexpr unsigned state_count = static_cast<unsigned>(CutState::fault) + 1U;
inline constexpr unsigned fault_count = static_cast<unsigned>(Fault::bad_configuration) + 1U;
inline constexpr unsigned limit_count = static_cast<unsigned>(Limit::roughness) + 1U;

constexpr const char* name(CutState state) {
    constexpr const char* names[state_count] = {"air", "entry", "in_cut", "exit", "hold", "fault"};
    return names[static_cast<unsigned>(state) % state_count];
}

constexpr const char* name(Fault fault) {
    constexpr const char* names[fault_count] = {"none", "overload", "stale_input", "spindle_stopped",
                                                "bad_configuration"};
    return names[static_cast<unsigned>(fault) % fault_count];
}

constexpr const char* name(Limit limit) {
    constexpr const char* names[limit_count] = {"none",        "force",          "override_max", "override_min",
                                                "air_feed",    "entry_feed",     "surge",        "operator_limit",
                                                "no_estimate", "feed_per_tooth", "roughness"};
    return names[static_cast<unsigned>(limit) % limit_count];
}

}  // namespace millforce::control
