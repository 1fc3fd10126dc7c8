// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "check/start_check.hpp"
#include "check/unseen_faults.hpp"
#include "commands/can_interface.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/map_options.hpp"
#include "commands/watch_options.hpp"
#include "daemon/can_daemon.hpp"
#include "daemon/journal.hpp"
#include "daemon/service.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "run_report/run_report.hpp"

namespace millforce::host {

namespace {

struct RunOptions {
    std::string interface;
    std::string machine;
    ToolChoice tools;
    std::string log;
    std::string record;
    std::string report;
    MapOptions maps{};
    BusPace pace{};
    WatchOptions watch{};
};

MachineBus bus_of(const std::string& machine_file) {
    const auto bus = read_machine_bus(machine_file);
    if (!bus) {
        throw InputError(
            fmt::format("{}: no drive on the bus; expected the tables [bus] and [bus.spindle], [bus.x], … with "
                        "node_id and tpdo1, "
                        "see 'millforce parameters'",
                        machine_file));
    }
    return *bus;
}

void print_summary(const RunOptions& options, const CanDaemon& daemon, const Journal& journal) {
    const socketcan::LinkHealth& link = daemon.link();
    const LatencyHistogram& latency = daemon.sync_to_override();
    fmt::print("{}: {} ticks; {} frames received, {} sent, {} not sent, {} lost\n", options.interface,
               daemon.controller().ticks(), link.received, link.sent, link.send_failures,
               link.overruns + link.controller_overflows);
    if (latency.total() > 0) {
        fmt::print("SYNC to override: median {:.2f} ms, 99 % {:.2f} ms, longest {:.2f} ms\n",
                   1e-3 * static_cast<double>(latency.quantile_us(0.5)),
                   1e-3 * static_cast<double>(latency.quantile_us(0.99)),
                   1e-3 * static_cast<double>(latency.largest_us()));
    }
    if (!options.record.empty()) {
        fmt::print("{}: {} frames\n", options.record, journal.recorded());
    }
}

int run_on_bus(const RunOptions& options) {
    options.tools.require_one();
    const ToolSet tools(read_machine_parameters(options.machine), options.tools);
    const MachineBus bus = bus_of(options.machine);
    show_start_check(tools);
    if ((options.pace.slow_motion != 1 || options.pace.lock_step) &&
        (bus.local.has_inputs() || bus.local.has_voltage() || bus.local.has_lines())) {
        throw InputError(
            fmt::format("--slow-motion, --lock-step: {} has [iio], [override_voltage] or [feed_hold_line], expected a "
                        "machine that is on the bus alone",
                        options.machine));
    }
    if (options.pace.lock_step && !bus.produces_sync) {
        throw InputError(fmt::format("--lock-step: {}: bus.produces_sync = false, expected true", options.machine));
    }
    const BusTime time{options.pace.slow_motion, options.pace.lock_step, bus.drives.sync_id, bus.drives.sync_period_us};
    const socketcan::CanSocketSettings interface = socket_on(options.interface);
    if (tools.source() != nullptr && program_status::tool_frame_id(bus.program.id) == 0) {
        throw InputError(
            fmt::format("--tools: {}: bus.program_status_id = {}, expected 1 to {}: the frame of the tool's "
                        "number is that id + 0x100",
                        options.machine, bus.program.id, hal::largest_standard_can_id - 0x100));
    }
    LiveMaps maps(options.maps, options.tools, tools);
    firmware::WaySource<float>* const way = maps.begin();
    if (way != nullptr && program_status::position_frame_id(bus.program.id) == 0) {
        throw InputError(
            fmt::format("--map, --learn: {}: bus.program_status_id = {}, expected 1 to {}: the frame of the position "
                        "in the program is that id + 0x200",
                        options.machine, bus.program.id, hal::largest_standard_can_id - 0x200));
    }
    const auto report =
        started_report({RunKind::run, options.interface, options.machine, options.tools, options.report}, tools);
    const auto notes = std::make_unique<RunNotes>();
    const std::atomic<bool>& stop = stop_on_signal();
    const auto journal = std::make_unique<Journal>(JournalSettings{options.interface, options.record, options.log,
                                                                   isatty(STDOUT_FILENO) != 0 && !options.watch.view,
                                                                   ToolForces(tools), notes.get()});
    const auto hub =
        watch(options.watch, tools, options.interface, recorder_of(report.get(), *notes, RunClock::samples));
    const auto daemon = std::make_unique<CanDaemon>(interface, bus, tools, *journal,
                                                    CanDaemonSettings{!options.record.empty(), time, hub->feed(), way});
    for (const std::string& fault : unseen_faults(tools.parameters())) {
        print_line(stderr, fmt::format("millforce: not seen here: {}", fault));
    }
    if (!options.pace.lock_step) {  // it never waits: it would leave a recorder no processor
        for (const std::string& note : become_real_time()) {
            print_line(stderr, fmt::format("millforce: note: {}", note));
        }
    }
    notify_service_manager("READY=1");
    daemon->run(stop);
    notify_service_manager("STOPPING=1");
    notify_service_manager(time_for_the_report);
    leave_real_time();
    journal->finish();
    hub->finish();
    print_summary(options, *daemon, *journal);
    for (const std::string& map : maps.dropped()) {
        print_line(stdout, fmt::format("the {} did not fit the cut: the run went on without it", map));
    }
    const bool is_learnt = maps.finish();
    const bool is_reported = finish_report(report.get(), stdout);
    if (!journal->failed_file().empty()) {
        print_line(stderr,
                   fmt::format("millforce: {}: a write failed; the file is incomplete", journal->failed_file()));
        return 1;
    }
    if (!hub->failed_file().empty()) {
        print_line(stderr, fmt::format("millforce: {}: a write failed; the file is incomplete", hub->failed_file()));
        return 1;
    }
    if (journal->lost() > 0) {
        print_line(stderr, fmt::format("millforce: the files are incomplete: {} entries were lost", journal->lost()));
        return 1;
    }
    return is_reported && is_learnt ? 0 : 1;
}

}  // namespace

void add_run(Command& program) {
    auto options = std::make_shared<RunOptions>();
    Command command = program.subcommand("run", "Run the live controller on a CAN interface");
    command.footer(
        "Runs until SIGINT, SIGTERM or SIGHUP; then the feed is held, and the heartbeat says 'stopped'. An interface\n"
        "that is not there, or goes down, is waited for. SIGUSR1 opens the files of --log and --record again, for\n"
        "logrotate. Conditions are reported on standard error; on a terminal a status line is printed each second.\n"
        "With --tools the CNC's tool frame holds the number; without a known tool the override is the operator's.\n"
        "Exit code 1: frames of --record or lines of --log are missing, or the page of --report could not be written.");
    command.option("interface", options->interface, "CAN interface, e.g. can0").required().value_name("IFACE");
    command.option("--machine", options->machine, "Machine parameters, with [bus]").required().value_name("M.toml");
    add_tools(command, options->tools);
    command.output_file("--log", options->log, "Write estimates and states as JSON lines").value_name("FILE.jsonl");
    command
        .output_file("--record", options->record,
                     "Every frame of the bus as a candump log, and this computer's own inputs, for 'millforce replay'")
        .value_name("FILE.log");
    add_map(command, options->maps);
    add_report(command, options->report);
    add_bus_pace(command, options->pace);
    add_watch(command, options->watch);
    command.on_run([options] { return run_on_bus(*options); });
}

}  // namespace millforce::host
