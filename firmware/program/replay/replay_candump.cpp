// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_candump.hpp"

#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <sstream>

#include "files/input_error.hpp"
#include "files/text_lines.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"
#include "replay/candump_replay.hpp"
#include "replay/estimate_table.hpp"
#include "replay/replay_mcap.hpp"
#include "replay/run_check.hpp"
#include "run_report/run_report.hpp"

namespace millforce::host {

namespace {

CandumpReplay::Settings settings_of(const ReplayCandumpOptions& options, const ToolSet& tools) {
    const auto bus = read_machine_bus(options.machine);
    if (!bus) {
        throw InputError(
            fmt::format("{}: no drive on the bus; expected the tables [bus] and [bus.spindle] … to read "
                        "the candump log {}",
                        options.machine, options.log));
    }
    return {options.log,
            options.interface,
            *bus,
            tools.parameters(),
            tools.source(),
            {options.pace.slow_motion, options.pace.lock_step, bus->drives.sync_id, bus->drives.sync_period_us},
            options.way};
}

double seconds_of(std::uint64_t microseconds) {
    return static_cast<double>(microseconds) / 1e6;
}

std::string summary_of(const CandumpReplay& replay) {
    return fmt::format(
        "{} frames, {} ticks{}{}", replay.frames(), replay.ticks(),
        replay.is_listener() ? ", as a listener: the log does not hold the start of a controller" : "",
        replay.not_used() > 0 ? fmt::format(", {} frames of CAN FD or errors left out", replay.not_used()) : "");
}

}  // namespace

bool is_candump_log(const std::string& file) {
    std::ifstream in = open_to_read(file);
    constexpr std::streamsize longest_look = 4096;
    std::string text(longest_look, '\0');
    in.read(text.data(), longest_look);
    text.resize(static_cast<std::size_t>(in.gcount()));
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first != std::string::npos && line[first] != '#') {
            return line[first] == '(';
        }
    }
    return false;
}

int replay_candump(const ReplayCandumpOptions& options, const ToolSet& tools,
                   const std::function<Playback()>& begin_playback) {
    CandumpReplay replay(settings_of(options, tools));
    Playback playback = begin_playback();
    EstimateTable table({options.log, options.output, options.interval_s, options.may_print}, tools,
                        WideBandSource::none);
    ReplayMcap mcap(options.mcap, tools);
    std::optional<RunCheck> check;
    if (!options.run_log.empty()) {
        check.emplace(options.run_log, ToolForces(tools));
    }
    const auto report =
        started_report({RunKind::replay, options.log, options.machine, options.tools, options.report}, tools);
    TickEntries entries(run_log_interval_us);
    replay.run(
        [&](const firmware::CanController& controller) {
            const firmware::TickRecord record = controller.record();
            if (report != nullptr) {
                report->history().add(seconds_of(record.time_us), record, controller.tool());
            }
            if (EstimateEntry entry; check && entries.add(record, controller.tool(), entry)) {
                check->add(entry);
            }
            const TelemetrySample shown{.tick = record,
                                        .tool = controller.tool(),
                                        .is_held = controller.sent_override().hold,
                                        .drives = controller.sample(),
                                        .program = controller.program(),
                                        .conditions = controller.conditions()};
            playback.show(seconds_of(record.time_us), shown);
            if (table.is_due(seconds_of(controller.tick_time_us()))) {
                table.write({seconds_of(record.time_us), record, controller.tool(), controller.controller().roughness(),
                             controller.controller().wide_band()});
                mcap.write(seconds_of(record.time_us), shown);
            }
        },
        [&](double share) { table.show_progress(share); });
    playback.finish();
    if (table.is_empty()) {
        throw InputError(
            fmt::format("{}: {} frames and no complete sample; expected SYNC and the PDOs of the machine's "
                        "[bus] tables",
                        options.log, replay.frames()));
    }
    table.show_notes();
    const int exit_code = check && !check->is_same() ? 1 : 0;
    if (check) {
        fmt::print(exit_code == 0 && table.goes_to_a_file() ? stdout : stderr, "{}", check->summary());
    }
    mcap.commit();
    table.commit("; " + summary_of(replay), {});
    return finish_report(report.get(), stderr) ? exit_code : 1;
}

}  // namespace millforce::host
