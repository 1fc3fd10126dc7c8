// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/map_options.hpp"
#include "commands/watch_options.hpp"
#include "daemon/service.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "firmware/tick_record.hpp"
#include "firmware/tool_tick.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/parameter_notes.hpp"
#include "parameters/tool_set.hpp"
#include "recording/recording.hpp"
#include "replay/estimate_table.hpp"
#include "replay/playback.hpp"
#include "replay/replay_candump.hpp"
#include "replay/replay_findings.hpp"
#include "replay/replay_mcap.hpp"
#include "replay/slow_samples.hpp"
#include "run_log/tool_forces.hpp"
#include "run_report/run_report.hpp"

namespace millforce::host {

namespace {

struct ReplayOptions {
    std::string log;
    std::string machine;
    ToolChoice tools;
    std::string output;
    std::optional<double> programmed_feed_mm_min;
    double interval_s = 0.02;
    std::string interface;
    std::string run_log;
    std::string report;
    std::string mcap;
    BusPace pace{};
    MapOptions maps{};
    WatchOptions watch{};
    double speed = 1.0;

    [[nodiscard]] bool is_watched() const { return watch.view || watch.web_port || !watch.udp_json.empty(); }
};

/// The program's status of each row: from the recording, with F from the command line if it was given.
hal::ProgramStatus program_of(const RecordingReader& recording, const ReplayOptions& options) {
    hal::ProgramStatus program = recording.program();
    if (options.programmed_feed_mm_min) {
        program.programmed_feed_mm_s = static_cast<float>(*options.programmed_feed_mm_min / 60.0);
    }
    return program;
}

void refuse_without_tool_numbers(const ToolSet& tools, const RecordingReader& recording, const std::string& log) {
    if (tools.source() != nullptr && !recording.has_tool()) {
        throw InputError(fmt::format("{}:1: expected the column tool with --tools", log));
    }
}

/// What the recording itself shows: contradictions between its columns, and forces that cannot be used.
void show_findings(const RecordingReader& recording, const ReplayFindings& findings, const std::string& log) {
    for (const std::string& finding : recording.has_force_sensor() ? std::vector<std::string>() : findings.notes()) {
        fmt::print(stderr, "millforce: note: {}: {}\n", log, finding);
    }
    if (recording.has_one_force_only()) {
        fmt::print(stderr, "millforce: note: {}: fx_N and fy_N are used together, and one of them is missing\n", log);
    }
}

/// A replay that nobody watches ends by a signal as any program does.
Playback playback_of(const ReplayOptions& options, const ToolSet& tools) {
    static const std::atomic<bool> never_stopped{false};
    const std::string title = std::filesystem::path(options.log).filename().string();
    return {watch(options.watch, tools, title, nullptr), options.speed,
            options.is_watched() ? stop_on_signal() : never_stopped};
}

/// What a slow source leaves out between two samples (replay/slow_samples.hpp).
void step_between(firmware::ToolTick& tick, const std::optional<hal::DriveSample>& last, const hal::DriveSample& now,
                  int parts, const hal::ProgramStatus& program) {
    for (int part = 1; last && part < parts; ++part) {
        firmware::step_and_work(tick, sample_between(*last, now, static_cast<double>(part) / parts), program);
    }
}

/// The same tick as in the loop, open: the recording goes in, estimates and the override that it would have commanded
/// come out.
int replay_table(const ReplayOptions& options) {
    const firmware::MachineParameters<float> machine = read_machine_parameters(options.machine);
    const int parts = parts_of_slow_samples(options.log, machine.encoder_counts_per_rev);
    const ToolSet tools(for_slow_samples(machine, parts), options.tools);
    const firmware::Parameters<float>& parameters = tools.parameters();
    RecordingReader recording(options.log, parameters.machine.encoder_counts_per_rev);
    if (!recording.has_force_sensor()) {
        show_parameter_notes(parameters);
    }
    refuse_without_tool_numbers(tools, recording, options.log);
    const auto report =
        started_report({RunKind::replay, options.log, options.machine, options.tools, options.report}, tools);
    firmware::ToolTick tick(parameters, tools.source());
    Playback playback = playback_of(options, tools);
    EstimateTable table({options.log, options.output, options.interval_s, !options.watch.view}, tools,
                        recording.has_force_sensor() ? WideBandSource::force_sensor : WideBandSource::drives);
    ReplayMcap mcap(options.mcap, tools);
    ReplayFindings findings(parameters.machine.encoder_counts_per_rev);
    std::optional<hal::DriveSample> last;
    while (recording.next()) {
        table.show_progress(recording.fraction_read());
        tick.follow_tool(recording.tool(), hal::axes_rest(recording.sample().axis_velocity_mm_s));
        step_between(tick, last, recording.sample(), parts, program_of(recording, options));
        last = recording.sample();
        const hal::FeedOverride output =
            firmware::step_and_work(tick, recording.sample(), program_of(recording, options));
        const firmware::TickRecord record = firmware::tick_record(tick.of_tool(), output, 0);
        findings.follow(recording.sample(), record);
        if (report != nullptr) {
            report->history().add(recording.time_s(), record, tick.tool());
        }
        const TelemetrySample shown{.tick = record,
                                    .tool = tick.tool(),
                                    .is_held = output.hold,
                                    .drives = recording.sample(),
                                    .program = program_of(recording, options)};
        playback.show(recording.time_s(), shown);
        if (table.is_due(recording.time_s())) {
            table.write(
                {recording.time_s(), record, tick.tool(), tick.of_tool().roughness(), tick.of_tool().wide_band()});
            mcap.write(recording.time_s(), shown);
        }
    }
    playback.finish();
    if (table.is_empty()) {
        throw InputError(fmt::format("{}: no rows after the header, expected a recording", options.log));
    }
    show_findings(recording, findings, options.log);
    if (parts > 1) {
        fmt::print(stderr,
                   "millforce: note: {}: the spindle turns by {:.2g} revolutions between two samples: forces are "
                   "averages, changes are seen late, and what happens within a revolution is not; or its angle is "
                   "not in radians\n",
                   options.log, parts / filled_samples_per_rev);
    }
    table.show_notes();
    mcap.commit();
    table.commit("", tick.of_tool().wide_band());
    return finish_report(report.get(), stderr) ? 0 : 1;
}

int replay(const ReplayOptions& options) {
    options.tools.require_one();
    if (!is_candump_log(options.log)) {
        if (options.maps.is_any()) {
            throw InputError(
                fmt::format("--map, --learn: {} is not a candump log, expected one with the CNC's position "
                            "frames",
                            options.log));
        }
        if (!options.run_log.empty() || options.pace.slow_motion != 1 || options.pace.lock_step) {
            throw InputError(fmt::format(
                "{}: not a candump log, expected one with --verify, --slow-motion or --lock-step", options.log));
        }
        return replay_table(options);
    }
    if (options.programmed_feed_mm_min) {
        throw InputError(fmt::format("--programmed-feed: {} is a candump log, expected F in its program status frames",
                                     options.log));
    }
    const ToolSet tools(read_machine_parameters(options.machine), options.tools);
    LiveMaps maps(options.maps, options.tools, tools);
    const int exit_code = replay_candump(
        {options.log, options.machine, options.tools, options.output, options.interface, options.interval_s,
         options.run_log, options.mcap, options.pace, options.report, maps.begin(), !options.watch.view},
        tools, [&] { return playback_of(options, tools); });
    for (const std::string& map : maps.dropped()) {
        print_line(stderr, fmt::format("millforce: the {} does not fit this cut: continuing without it", map));
    }
    return maps.finish() ? exit_code : 1;
}

/// Stopped by who watches: nothing is written, and the shell sees the signal.
int replay_to_the_end(const ReplayOptions& options) {
    if (options.speed != 1.0 && !options.is_watched()) {
        throw InputError(
            "--speed: expected one of --view, --web and --udp-json with it; a replay that nobody watches runs as fast "
            "as it can");
    }
    try {
        return replay(options);
    } catch (const PlaybackStopped&) {
        std::signal(SIGINT, SIG_DFL);
        std::raise(SIGINT);
    }
    return 1;
}

}  // namespace

void add_replay(Command& program) {
    auto options = std::make_shared<ReplayOptions>();
    Command command = program.subcommand("replay", "Run estimation and control (open loop) on a recording");
    command.footer(
        "Columns of the recording: time_s, spindle_angle_rad, spindle_current_A, and AXIS_current_A and\n"
        "AXIS_velocity_mm_s for those of x, y, z that exist. A recording of 'simulate --record' also holds the index\n"
        "pulses and the program's feed, and its replay reproduces the simulation's estimates digit for digit.\n"
        "An empty cell of the estimates is \"no estimate\". cut_side is the side that the forces fit, law_misfit\n"
        "how badly the tool's law explains them (above 16: no immersion), limit what holds the override down.\n"
        "A tool with a [roughness] table adds its prediction with the 95 % interval, and whether the cut is in the\n"
        "range of the model's tests.\n"
        "With a force sensor (fx_N, fy_N on the workpiece, in the machine's axes; currents may be missing) it adds "
        "the\n"
        "radial immersion from force drops and both depths from the force's shape, by the tool's tables\n"
        "[force_sensor], [force_drop] and [depth_shape].\n"
        "With --tools the column tool, or the log's tool frames, give the number of the tool.\n"
        "A candump log ('candump -l', 'candump -L', 'millforce run --record') is decoded with the machine's [bus] "
        "tables.\n"
        "What was recorded during 'millforce run', from its start on, gives the estimates of that run digit for "
        "digit.");
    command.option("log", options->log, "Recording: CSV, or a candump log").required().value_name("LOG");
    command.option("--machine", options->machine, "Machine parameters").required().value_name("M.toml");
    add_tools(command, options->tools);
    command.output_file("-o,--output", options->output, "Estimates; default: standard output; with --view: nowhere")
        .value_name("OUT.csv");
    command
        .output_file("--mcap", options->mcap,
                     "The same rows with currents and velocities, as MCAP for Foxglove and PlotJuggler")
        .value_name("OUT.mcap");
    command
        .option("--programmed-feed", options->programmed_feed_mm_min,
                "Programmed feed F in mm/min, for the override; default: from the recording, else unknown")
        .value_name("F")
        .within(0.0, 1e6);
    command.option("--interval", options->interval_s, "Time between two rows in s; 0: a row for each sample")
        .value_name("S")
        .within(0.0, 1e6)
        .shows_default();
    command.option("--interface", options->interface, "Interface to replay, if a candump log has several")
        .value_name("IFACE");
    command
        .option("--verify", options->run_log,
                "Compare with the log of 'millforce run --log'; exit code 1 if one bit of one tick differs")
        .value_name("RUN.jsonl");
    add_map(command, options->maps);
    add_report(command, options->report);
    add_bus_pace(command, options->pace);
    add_live_watch(command, options->watch);
    command
        .option("--speed", options->speed,
                "With --view, --web or --udp-json, which end with the recording: times the speed at which it was made")
        .value_name("X")
        .within(0.01, 20.0)
        .shows_default();
    command.on_run([options] { return replay_to_the_end(*options); });
}

}  // namespace millforce::host
