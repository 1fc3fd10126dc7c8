// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_words.hpp"

#include <cstddef>

namespace millforce::host {

const char* meaning_of(control::CutState state) {
    constexpr const char* meanings[control::state_count] = {
        "The tool is in air.",
        "The tool has just met the workpiece, and how deep it cuts is still being found out.",
        "The tool cuts, and the estimate describes the cut.",
        "The cut has ended or has a gap. The feed is kept as it was.",
        "The feed is held, or there is no estimate. The feed is not raised.",
        "The controller has given up and holds the feed. Someone has to reset it.",
    };
    return meanings[static_cast<unsigned>(state) % control::state_count];
}

const char* meaning_of(control::Fault fault) {
    constexpr const char* meanings[control::fault_count] = {
        "there is none.",
        "the load on a tooth stayed above the level at which the feed is stopped, before the tooth breaks.",
        "no sample of the drives came in time, or their clock stood still.",
        "the spindle or its encoder stood still while the tool was in the cut.",
        "the parameters contradict each other.",
        "a motor current showed the same value for far longer than it ever does.",
        "the torque fell faster than any cut ends: a signal failed, or the tool broke off.",
        "the current of an axis jumped as no cut makes it jump.",
        "the currents of the axes showed a cut and the spindle's current none.",
        "the spindle's torque was below its idle torque.",
        "the spindle's current showed a cut in a rapid move.",
        "the axes were faster than programmed feed and override allow.",
        "the spindle's encoder jumped in speed, or disagreed with its index pulse.",
        "in air the spindle's current was not the one that it was calibrated with.",
    };
    return meanings[static_cast<unsigned>(fault) % control::fault_count];
}

const char* meaning_of(firmware::Condition condition) {
    static constexpr const char* meanings[] = {
        "there is no such CAN interface",
        "the CAN interface is down",
        "the CAN bus has many errors, but frames flow",
        "the CAN bus has very many errors, but frames flow",
        "the CAN controller has left the bus after too many errors",
        "frames cannot be sent: nobody on the bus takes them",
        "frames came faster than they were fetched, and some are lost",
        "the SYNC frames stay away",
        "another node sends SYNC, too",
        "waiting for a drive to answer",
        "a drive refused what it was asked",
        "a drive does not answer any more",
        "a drive is not enabled, and the feed is held",
        "a drive reports an error",
        "speed and position of a drive contradict each other",
        "the last sample lacks a value of a drive",
        "no complete sample came for too long",
        "the CNC has not sent its status, so the override stays where it is",
        "the CNC stopped sending its status, and the feed is held",
        "the CNC sent no tool number that is known, so the override is the operator's",
        "the tool's number changed in motion: the last tool's limits hold until the axes rest",
        "an input of this computer does not answer",
        "the override does not reach an output of this computer, and the feed is held",
        "another node sends the override, too, and the feed is held",
        "this program was stopped for a while, and the feed is held until a newer sample comes",
        "the part map does not fit this cut, and the controller goes on without it",
    };
    static_assert(sizeof meanings / sizeof meanings[0] == firmware::condition_count);
    return meanings[static_cast<std::size_t>(condition) % firmware::condition_count];
}

const CeilingWords& words_of(control::Limit limit) {
    static constexpr CeilingWords words[] = {
        {"nothing", "", "The feed was the programmed one, as in rapid moves."},
        {"load on a tooth", "tooth_force_limit_N, setpoint_share",
         "The load on a tooth was where it should be: at its limit, less a margin."},
        {"largest override", "override_max", "The machine takes no higher feed override."},
        {"smallest override", "override_min",
         "Some other ceiling asked for less than the smallest override that is sent."},
        {"feed in air", "air_feed_per_tooth_mm, safe_override",
         "In air the feed stays so low that the tool may meet the workpiece at any moment."},
        {"entry feed", "entry_feed_per_tooth_mm",
         "From contact until the engagement is known, and while plunging, the feed stays low."},
        {"what may come", "surge_radial_immersion, turn_radial_immersion, safe_override",
         "More material might have come without warning, at a wall or after a turn of the path, faster than the feed "
         "can fall."},
        {"the operator", "", "The operator's own override or feed hold was lower, or the tool is set to monitor_only."},
        {"no estimate", "",
         "The forces gave no estimate. In the cut the feed stayed as it was, out of the cut it was at its minimum."},
        {"feed per tooth", "max_feed_per_tooth_mm", "The edge and the chip space of the tool take no thicker chip."},
        {"surface roughness", "Ra_limit_um", "A faster feed might have made the surface rougher than it may be."},
        {"forces that contradict each other", "",
         "The forces did not fit together, or did not fit the tool's calibration, so the feed was not raised."},
        {"what lies ahead", "",
         "By the part map a place ahead needed a lower feed, and the machine had to brake for it."},
        {"axes too fast", "",
         "The axes moved faster than the programmed feed and the override allow, so the feed was not raised."},
        {"a step of the depth", "depth_step_ratio, depth_step_share, safe_override",
         "The depth might have grown without warning, faster than the feed can fall. A part map, "
         "<code>declared_axial_depth_mm</code> or <code>depth_step_ratio = 1</code> for a part without steps lift it; "
         "<code>safe_override</code> for a program whose F is safe raises it."},
        {"a load that was asked", "load_period_s",
         "The spindle's load, which comes seldom, had not changed as the feed did, or had stood still for 2 s."},
        {"the spindle's torque", "",
         "The spindle had lost more than 5 % of its speed in a cut: its drive was at its torque limit. From then on "
         "the force was kept below the one at which it did."},
        {"a current that may have drifted", "",
         "The cut seemed to become wider and the tooth's force smaller. A current that drifts looks the same, so the "
         "feed dipped, to see whether both forces follow it, or waited for that."},
        {"load on a tooth, at the smallest override", "override_min, tooth_force_limit_N",
         "A tooth may have carried more than its limit although the override was the smallest that may be sent. Lower "
         "F "
         "or <code>override_min</code>, or cut less deep or wide."},
    };
    static_assert(sizeof words / sizeof words[0] == control::limit_count);
    return words[static_cast<unsigned>(limit) % control::limit_count];
}

}  // namespace millforce::host
