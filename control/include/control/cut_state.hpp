// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The names that the controller shows: where the tool stands (CutState), why the controller has given up (Fault), and
/// what holds the override down (Limit). Their numbers go out over CAN and into records: append, never renumber.

namespace millforce::control {

/// Where the tool stands in relation to the cut, as the forces show it. CutStates (cut_states.hpp) moves between them.
/// Any state but `fault` is left for `hold` while the feed is held, and for `fault` by each of the faults below.
enum class CutState : std::uint8_t {
    /// No contact.
    /// Entered: at the start, and from `exit` after the exit travel without contact or at a sharp turn of the path.
    /// Left: contact → entry; fed for exit_travel_mm without an estimate, and the spindle turns forwards → hold.
    air = 0,

    /// The cutter enters the workpiece, and its engagement still grows.
    /// Entered: by contact, from air, exit or hold.
    /// Left: after the entry revolutions and the entry travel, both → in_cut; contact lost → exit; no estimate for
    /// longer than no_estimate_hold_s → hold.
    entry = 1,

    /// The cutter is in the cut, and the estimate describes it.
    /// Entered: from entry, and from a hold in the cut.
    /// Left: contact lost → exit; no estimate for longer than no_estimate_hold_s → hold.
    in_cut = 2,

    /// Contact was lost: the end of a cut or a gap in it. The feed of the cut is kept, not raised.
    /// Entered: from entry or in_cut by lost contact, and from hold by an estimate without contact.
    /// Left: contact → entry; after the exit travel without contact, or at a sharp turn of the path → air; without an
    /// estimate as air.
    exit = 3,

    /// There is no estimate, or the feed is held or was until now: the override is not raised. Without an estimate the
    /// feed is held as well, but not in a rapid.
    /// Entered: from any state but fault while the feed is held, or without an estimate; from fault by a reset.
    /// Left: by the next estimate once the feed is free, with contact → entry, without → exit; → air once spindle and
    /// axes have stood still for 2 s. Where the axes stopped in a cut, or a fault was reset, the tool may stand in its
    /// cut, where the engagement is there at once: contact → in_cut; the exit travel without contact → exit.
    hold = 4,

    /// The controller has given up: lowest override, feed held.
    /// Entered: from any state, by a Fault.
    /// Left: by FeedController::reset() alone, → hold.
    fault = 5,
};

/// The tool cuts, as far as the forces show: the law is in charge, and a rise needs a fresh estimate.
[[nodiscard]] constexpr bool is_cutting(CutState state) {
    return state == CutState::entry || state == CutState::in_cut;
}

/// The forces show no contact: the law has nothing to say.
[[nodiscard]] constexpr bool is_out_of_cut(CutState state) {
    return state == CutState::air || state == CutState::exit;
}

/// Why the controller has given up. Latched; every fault ends at the minimum override with the feed held.
enum class Fault : std::uint8_t {
    none = 0,
    overload = 1,     ///< the tooth's force stayed above the stop level: the feed is held before the tooth breaks
    stale_input = 2,  ///< no drive sample with encoder and spindle current within the time limit, or their clock stands
    spindle_stopped = 3,  ///< the spindle, or its encoder, stands while the tool is in cut; or the spindle stalls
    bad_configuration = 4,
    // Signals that contradict each other or physics: firmware/signal_supervisor.hpp says when.
    signal_stuck = 5,       ///< a motor current shows the same value for far longer than it ever did
    force_vanished = 6,     ///< the torque fell faster than any cut ends: the signal failed, or the tool broke off
    force_jumped = 7,       ///< an axis' current jumped as no cut does
    forces_contradict = 8,  ///< the axes carry a cut, and the spindle's current shows none
    negative_torque = 9,    ///< the spindle's torque is below its idle torque
    contact_in_rapid = 10,  ///< the spindle's current shows a cut in a rapid move
    feed_mismatch = 11,     ///< the axes are faster than programmed feed and override allow
    encoder_mismatch = 12,  ///< the spindle's count jumps in speed, or disagrees with its index pulse
    idle_torque = 13,       ///< in air the spindle's current is not the one that its calibration leaves open
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
    no_estimate = 8,  ///< there is no estimate: held where it was, out of the cut at its minimum
    feed_per_tooth = 9,
    roughness = 10,         ///< the upper bound of the predicted R_a is at its limit
    law_misfit = 11,        ///< held where it was: the forces contradict each other, the law, or the declared depth
    way_ahead = 12,         ///< the part map knows a place ahead that the machine must be slow enough for
    feed_mismatch = 13,     ///< held where it was: the axes are faster than programmed feed and largest override allow
    depth_step = 14,        ///< as `surge`, of the depth: by depth_step_ratio
    load_unanswered = 15,   ///< the spindle's load, which comes seldom, has not changed as the feed did, or for 2 s
    spindle_torque = 16,    ///< the spindle loses its speed in the cut, or has lost it at a force as large
    current_in_doubt = 17,  ///< a current may have drifted in the cut: a dip of the feed asks, or is waited for
    force_at_minimum = 18,  ///< as override_min, and a tooth may carry more than its limit there: no feed helps
};

inline constexpr unsigned state_count = static_cast<unsigned>(CutState::fault) + 1U;
inline constexpr unsigned fault_count = static_cast<unsigned>(Fault::idle_torque) + 1U;
inline constexpr unsigned limit_count = static_cast<unsigned>(Limit::force_at_minimum) + 1U;

constexpr const char* name(CutState state) {
    constexpr const char* names[state_count] = {"air", "entry", "in_cut", "exit", "hold", "fault"};
    return names[static_cast<unsigned>(state) % state_count];
}

constexpr const char* name(Fault fault) {
    constexpr const char* names[fault_count] = {"none",
                                                "overload",
                                                "stale_input",
                                                "spindle_stopped",
                                                "bad_configuration",
                                                "signal_stuck",
                                                "force_vanished",
                                                "force_jumped",
                                                "forces_contradict",
                                                "negative_torque",
                                                "contact_in_rapid",
                                                "feed_mismatch",
                                                "encoder_mismatch",
                                                "idle_torque"};
    return names[static_cast<unsigned>(fault) % fault_count];
}

constexpr const char* name(Limit limit) {
    constexpr const char* names[limit_count] = {"none",
                                                "force",
                                                "override_max",
                                                "override_min",
                                                "air_feed",
                                                "entry_feed",
                                                "surge",
                                                "operator_limit",
                                                "no_estimate",
                                                "feed_per_tooth",
                                                "roughness",
                                                "law_misfit",
                                                "way_ahead",
                                                "feed_mismatch",
                                                "depth_step",
                                                "load_unanswered",
                                                "spindle_torque",
                                                "current_in_doubt",
                                                "force_at_minimum"};
    return names[static_cast<unsigned>(limit) % limit_count];
}

}  // namespace millforce::control
