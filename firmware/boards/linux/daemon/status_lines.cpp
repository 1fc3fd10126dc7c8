// SPDX-License-Identifier: Apache-2.0
#include "daemon/status_lines.hpp"

#include <fmt/format.h>

#include <cstring>
#include <utility>

#include "control/cut_state.hpp"
#include "files/csv.hpp"
#include "parameters/drive_names.hpp"
#include "run_log/bus_names.hpp"
#include "run_log/estimate_line.hpp"
#include "run_report/run_words.hpp"

namespace millforce::host {

namespace {

using firmware::Condition;

constexpr const char* link_state_name(socketcan::LinkState state) {
    constexpr const char* names[] = {"absent", "down", "error_active", "error_warning", "error_passive", "bus_off"};
    return names[static_cast<std::size_t>(state) % 6U];
}

/// Whether a drive is the cause of a condition.
bool causes(const cia402::NodeHealth& drive, Condition condition) {
    using cia402::NodeState;
    switch (condition) {
        case Condition::drive_preparing:
            return drive.state == NodeState::preparing || drive.state == NodeState::starting;
        case Condition::drive_refused:
            return drive.state == NodeState::refused;
        case Condition::drive_lost:
            return drive.state == NodeState::lost;
        case Condition::drive_not_enabled:
            return cia402::is_faulted(drive.power) || drive.power == cia402::PowerState::quick_stop_active;
        case Condition::drive_emergency:
            return drive.emergency_active;
        case Condition::drive_units_disagree:
            return drive.units_disagree;
        default:
            return false;
    }
}

std::string drive_json(const cia402::NodeHealth& drive) {
    std::string text = fmt::format(R"({{"state":"{}","power":"{}","times_lost":{})", name(drive.state),
                                   name(drive.power), drive.times_lost);
    if (drive.emergency.error_code != 0) {
        text += fmt::format(R"(,"emergency":"0x{:04X}")", drive.emergency.error_code);
    }
    if (drive.sdo_abort_code != 0) {
        text += fmt::format(R"(,"sdo_abort":"0x{:08X}")", drive.sdo_abort_code);
    }
    return text + "}";
}

std::string conditions_json(const firmware::Conditions& conditions) {
    std::string text;
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        if (const auto condition = static_cast<Condition>(k); conditions.has(condition)) {
            text += fmt::format(R"({}"{}")", text.empty() ? "" : ",", firmware::name(condition));
        }
    }
    return "[" + text + "]";
}

std::string drives_json(const StatusEntry& entry) {
    std::string text;
    for (std::size_t k = 0; k < entry.drives.size(); ++k) {
        if (entry.is_used[k]) {
            text += fmt::format(R"({}"{}":{})", text.empty() ? "" : ",", drive_names[k], drive_json(entry.drives[k]));
        }
    }
    return "{" + text + "}";
}

std::string rejects_json(const cia402::RejectCounters& rejects) {
    std::string text;
    for (std::size_t k = 0; k < cia402::reject_reasons; ++k) {
        if (const auto reason = static_cast<cia402::Reject>(k); rejects[reason] > 0) {
            text += fmt::format(R"({}"{}":{})", text.empty() ? "" : ",", name(reason), rejects[reason]);
        }
    }
    return "{" + text + "}";
}

std::string link_json(const socketcan::LinkHealth& link) {
    return fmt::format(R"({{"state":"{}","received":{},"sent":{},"send_failures":{},"overruns":{},)"
                       R"("controller_overflows":{},"error_frames":{},"bus_offs":{},"restarts":{}}})",
                       link_state_name(link.state), link.received, link.sent, link.send_failures, link.overruns,
                       link.controller_overflows, link.error_frames, link.bus_offs, link.restarts);
}

std::string file_fault(const iio::Fault& fault, int error) {
    const int number = fault.number != 0 ? fault.number : error;
    std::string text = fault.file.view().empty() ? "" : fmt::format(": {}", fault.file.view());
    if (fault.error != iio::IioError::none) {
        text += fmt::format(": {}", iio::name_of(fault.error));
    }
    return text + (number != 0 ? fmt::format(" ({})", std::strerror(number)) : "");
}

/// Whose fault a condition is, or how long it was, in brackets.
std::string culprit(const StatusEntry& entry, Condition condition) {
    if (condition == Condition::local_input_failed) {
        return entry.input.what + file_fault(entry.input.fault, 0);
    }
    if (condition == Condition::local_output_failed) {
        return entry.output.what + file_fault(entry.output.fault, entry.output.error);
    }
    if (condition == Condition::process_paused) {
        return fmt::format("{:.1f} s", 1e-6 * static_cast<double>(entry.pause_us));
    }
    std::string drives;
    for (std::size_t place = 0; place < entry.drives.size(); ++place) {
        if (entry.is_used[place] && causes(entry.drives[place], condition)) {
            drives += (drives.empty() ? "" : ", ") + std::string(drive_names[place]);
        }
    }
    return drives;
}

/// Each with whose fault it is, and with what `explain` says of it.
template <typename Explain>
std::string joined_conditions(const StatusEntry& entry, const char* separator, Explain explain) {
    std::string text;
    for (std::size_t k = 0; k < firmware::condition_count; ++k) {
        const auto condition = static_cast<Condition>(k);
        if (!entry.conditions.has(condition)) {
            continue;
        }
        const std::string drives = culprit(entry, condition);
        text += (text.empty() ? "" : separator) + std::string(firmware::name(condition)) +
                (drives.empty() ? "" : " (" + drives + ")") + explain(condition);
    }
    return text;
}

}  // namespace

std::string json_line(const StatusEntry& entry) {
    return fmt::format(
        "{{\"type\":\"{}\",\"time_s\":{},\"conditions\":{},\"drives\":{},\"link\":{},\"ticks\":{},\"syncs\":{},"
        "\"syncs_skipped\":{},\"samples_incomplete\":{},\"rejects\":{}}}\n",
        entry.is_periodic ? "status" : "conditions", json_time(entry.unix_us), conditions_json(entry.conditions),
        drives_json(entry), link_json(entry.link), entry.ticks, entry.bus.syncs, entry.syncs_skipped,
        entry.bus.samples_incomplete, rejects_json(entry.rejects));
}

std::string condition_list(const StatusEntry& entry) {
    return joined_conditions(entry, ", ", [](Condition) { return std::string(); });
}

std::string condition_words(const StatusEntry& entry) {
    return joined_conditions(entry, "; ",
                             [](Condition condition) { return std::string(": ") + meaning_of(condition); });
}

std::string status_line(const StatusEntry& entry) {
    const firmware::TickRecord& tick = entry.newest.tick;
    const hal::FeedOverride& out = tick.feed_override;
    const std::string force = CsvWriter::cell(tick.tangential_force_N);
    const std::string conditions = condition_list(entry);
    std::string text = fmt::format("{}: {}, override {:.0f} %{}", link_state_name(entry.link.state),
                                   control::name(static_cast<control::CutState>(out.state)), 100.0F * out.ratio,
                                   out.hold ? ", hold" : "");
    if (!force.empty()) {
        text += fmt::format(", F_t {:.0f} N", tick.tangential_force_N);
    }
    if (tick.radial_immersion == tick.radial_immersion) {
        text += fmt::format(", immersion {:.2f}", tick.radial_immersion);
    }
    if (tick.axial_depth_mm == tick.axial_depth_mm) {
        text += fmt::format(", depth {:.1f} mm", tick.axial_depth_mm);
    }
    return text + (conditions.empty() ? "" : "; " + conditions);
}

}  // namespace millforce::host
