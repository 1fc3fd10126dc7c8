// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_candump.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"
#include "replay/candump_replay.hpp"
#include "replay/estimate_rows.hpp"
#include "replay/run_check.hpp"

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
            {options.pace.slow_motion, options.pace.lock_step, bus->drives.sync_id, bus->drives.sync_period_us}};
}

double seconds_of(std::uint64_t microseconds) {
    return static_cast<double>(microseconds) / 1e6;
}

std::string summary_of(const CandumpReplay& replay) {
    return fmt::format(
        "{} frames, {} ticks{}{}\n", replay.frames(), replay.ticks(),
        replay.is_listener() ? ", as a listener: the log does not hold the start of a controller" : "",
        replay.not_used() > 0 ? fmt::format(", {} frames of CAN FD or errors left out", replay.not_used()) : "");
}

}  // namespace

bool is_candump_log(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        throw InputError(fmt::format("{}: no such file", file));
    }
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

int replay_candump(const ReplayCandumpOptions& options) {
    const ToolSet tools(read_machine_parameters(options.machine), options.tools);
    CandumpReplay replay(settings_of(options, tools));
    std::optional<AtomicFile> file;
    if (!options.output.empty()) {
        file.emplace(options.output);
    }
    // Without a file, rows go out when all are good.
    std::ostringstream held_back;
    std::ostream& out = file ? file->stream() : held_back;
    const ToolForces forces(tools);
    ToolCells numbers(forces.has_numbers());
    // The model is a tool's own: another may have another one, or none.
    RoughnessCells roughness(forces.has_numbers() ? estimation::RoughnessModel<float>()
                                                  : tools.parameters().tool.roughness);
    out << estimate_header;
    numbers.write_header(out);
    roughness.write_header(out);
    out << '\n';
    Progress progress("replaying");
    std::optional<RunCheck> check;
    if (!options.run_log.empty()) {
        check.emplace(options.run_log, forces);
    }
    TickEntries entries(run_log_interval_us);
    const auto interval_us = static_cast<std::uint64_t>(std::llround(options.interval_s * 1e6));
    std::uint64_t next_row_us = 0;
    std::size_t rows = 0;
    replay.run(
        [&](const firmware::CanController& controller) {
            if (EstimateEntry entry; check && entries.add(controller.record(), controller.tool(), entry)) {
                check->add(entry);
            }
            if (controller.tick_time_us() < next_row_us) {
                return;
            }
            next_row_us = controller.tick_time_us() + interval_us;
            const firmware::TickRecord record = controller.record();
            write_estimate_row(out, seconds_of(record.time_us), record, forces.of(record, controller.tool()));
            numbers.write(out, controller.tool());
            roughness.write(out, controller.controller().roughness());
            out << '\n';
            ++rows;
        },
        [&](double share) { progress.update(share); });
    if (rows == 0) {
        throw InputError(
            fmt::format("{}: {} frames and no complete sample; expected SYNC and the PDOs of the machine's "
                        "[bus] tables",
                        options.log, replay.frames()));
    }
    if (const std::string note = numbers.note(); !note.empty()) {
        fmt::print(stderr, "millforce: note: {}: {}\n", options.log, note);
    }
    const int exit_code = check && !check->is_same() ? 1 : 0;
    if (check) {
        fmt::print(exit_code == 0 && file ? stdout : stderr, "{}", check->summary());
    }
    if (!file) {
        std::cout << held_back.str();
        return exit_code;
    }
    file->commit();
    fmt::print("{}: {} rows; {}{}", options.output, rows, summary_of(replay), roughness.summary());
    return exit_code;
}

}  // namespace millforce::host
