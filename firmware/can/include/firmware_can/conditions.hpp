// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// What is wrong, or not yet right, by name. Nothing here latches: a condition lasts as long as its cause.

namespace millforce::firmware {

enum class Condition : std::uint8_t {
    interface_absent,  ///< no such interface, or a kernel without CAN
    interface_down,
    error_warning,  ///< of the CAN controller at its warning limit; frames flow
    error_passive,  ///< CAN controller beyond it; frames flow
    bus_off,
    send_queue_full,       ///< ENOBUFS
    frames_lost,           ///< overruns: frames came faster than they were fetched, within the last second
    sync_lost,             ///< no SYNC for three periods
    sync_foreign,          ///< another node sends SYNC; within the last second
    drive_preparing,       ///< a drive is asked or written to, or waited for
    drive_refused,         ///< a drive refused an SDO transfer
    drive_lost,            ///< a drive's heartbeat stays away
    drive_not_enabled,     ///< a drive's statusword shows a fault or a quick stop: the feed is held
    drive_emergency,       ///< a drive's last EMCY is an error
    drive_units_disagree,  ///< velocity and position give different speeds
    input_incomplete,      ///< the last sample lacks a quantity of a drive
    input_stale,           ///< no complete sample for so long that the tick faults
    program_unknown,       ///< the CNC has not sent its status: the override stays where it is
    program_silent,        ///< the CNC sent its status and then stopped: the feed is held
    tool_unknown,     ///< the CNC has sent no tool number that there are parameters for: the override is the operator's
    tool_change_due,  ///< the number changed in motion: the last tool's limits hold until the axes rest
    local_input_failed,   ///< a converter or counter of this computer is absent, unreadable or silent
    local_output_failed,  ///< the override does not reach this computer's converter or lines: it says hold everywhere
    override_foreign,     ///< another node sends this controller's override or heartbeat: the feed is held
    process_paused,       ///< this process was stopped for longer than `stale_s`: the feed is held until a newer sample
    map_refuted,          ///< the part map does not fit the cut: the controller goes on without it
};
inline constexpr std::size_t condition_count = static_cast<std::size_t>(Condition::map_refuted) + 1;

constexpr const char* name(Condition condition) {
    constexpr const char* names[] = {
        "interface_absent", "interface_down",     "error_warning",       "error_passive",    "bus_off",
        "send_queue_full",  "frames_lost",        "sync_lost",           "sync_foreign",     "drive_preparing",
        "drive_refused",    "drive_lost",         "drive_not_enabled",   "drive_emergency",  "drive_units_disagree",
        "input_incomplete", "input_stale",        "program_unknown",     "program_silent",   "tool_unknown",
        "tool_change_due",  "local_input_failed", "local_output_failed", "override_foreign", "process_paused",
        "map_refuted"};
    static_assert(sizeof names / sizeof names[0] == condition_count);
    return names[static_cast<std::size_t>(condition) % condition_count];
}

class Conditions {
  public:
    void set(Condition condition, bool is_there) {
        const std::uint32_t bit = 1U << static_cast<unsigned>(condition);
        bits_ = is_there ? bits_ | bit : bits_ & ~bit;
    }
    [[nodiscard]] bool has(Condition condition) const {
        return (bits_ & (1U << static_cast<unsigned>(condition))) != 0;
    }
    void add(const Conditions& others) { bits_ |= others.bits_; }
    [[nodiscard]] bool none() const { return bits_ == 0; }
    [[nodiscard]] bool operator==(const Conditions&) const = default;

  private:
    std::uint32_t bits_ = 0;
};

}  // namespace millforce::firmware
