// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "files/progress.hpp"
#include "firmware/tick_record.hpp"
#include "firmware/tool_tick.hpp"
#include "firmware/wide_band_settings.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/parameter_notes.hpp"
#include "parameters/tool_set.hpp"
#include "recording/recording.hpp"
#include "replay/estimate_rows.hpp"
#include "replay/replay_candump.hpp"
#include "replay/replay_findings.hpp"
#include "run_log/tool_forces.hpp"

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
    BusPace pace{};
};

/// The columns of the wide-band methods, where the recording has a force sensor or the tool's parameters ask for force
/// drops from the drives. Missing parameters are reported once, on standard error; the cells are then empty.
class WideBandCells {
  public:
    using Estimates = firmware::WideBandEstimate<float>;

    WideBandCells(bool has_sensor, const firmware::ToolParameters<float>& tool)
        : tool_(tool), has_sensor_(has_sensor), is_there_(has_sensor || firmware::has_force_drop_law(tool_)) {}

    void tell_what_is_missing() const {
        for (const std::string_view line : {lacking_for_force_drops(), lacking_for_depths()}) {
            if (has_sensor_ && !line.empty()) {
                fmt::print(stderr, "millforce: note: {}\n", line);
            }
        }
    }
    void write_header(std::ostream& out) const {
        out << (is_there_ ? ",force_drop_immersion,force_drop_immersion_sd,depth_shape_axial_depth_mm,"
                            "depth_shape_axial_depth_sd_mm,depth_shape_radial_width_mm,depth_shape_radial_width_sd_mm,"
                            "depth_shape_axial_variation_percent,depth_shape_radial_variation_percent"
                          : "");
    }
    void write(std::ostream& out, const Estimates& made) const {
        if (!is_there_) {
            return;
        }
        write_with_sd(out, made.force_drop_immersion);
        write_with_sd(out, made.axial_depth_mm);
        write_with_sd(out, made.radial_width_mm);
        write_variation(out, made.axial_depth_mm, tool_.depth_shape.nominal_axial_depth_mm);
        write_variation(out, made.radial_width_mm, tool_.depth_shape.nominal_radial_width_mm);
    }
    [[nodiscard]] std::string summary(const Estimates& made) const {
        std::string text;
        if (is_there_ && lacking_for_force_drops().empty()) {
            text += fmt::format("immersion from force drops: {} estimates of {} that were due\n",
                                made.force_drops_valid, made.force_drops);
        }
        if (has_sensor_ && lacking_for_depths().empty()) {
            text += fmt::format("depths from the force's shape: {} estimates of {} that were due\n", made.depths_valid,
                                made.depths);
        }
        return text;
    }

  private:
    using Estimate = estimation::Measurement<float>;

    [[nodiscard]] std::string_view lacking_for_force_drops() const {
        if (!firmware::has_force_drop_law(tool_)) {
            return "no immersion from force drops: the tool has no calibrated [force_drop] table";
        }
        return has_sensor_ && !firmware::has_force_sensor(tool_)
                   ? "no immersion from force drops of the sensor: the tool's [force_sensor] table has no low_pass_hz"
                   : "";
    }
    [[nodiscard]] std::string_view lacking_for_depths() const {
        if (!firmware::has_nominal_depths(tool_)) {
            return "no depths from the force's shape: the tool's [depth_shape] table has no nominal_axial_depth_mm or "
                   "no nominal_radial_width_mm";
        }
        if (!firmware::force_has_shape(tool_)) {
            return "no depths from the force's shape: it takes a helix of at least 5° and a wall to one side";
        }
        return firmware::has_force_sensor(tool_)
                   ? ""
                   : "no depths from the force's shape: the tool's [force_sensor] table has no low_pass_hz";
    }

    static void write_with_sd(std::ostream& out, const Estimate& m) {
        out << ',' << (m.valid ? CsvWriter::cell(m.value) + ',' + CsvWriter::cell(std::sqrt(m.variance)) : ",");
    }
    static void write_variation(std::ostream& out, const Estimate& m, float nominal) {
        out << ',' << (m.valid ? CsvWriter::cell(100.0F * (m.value / nominal - 1.0F)) : "");
    }

    firmware::ToolParameters<float> tool_;
    bool has_sensor_;
    bool is_there_;
};

/// Which samples get a row: the first, and then one after each interval, to the microsecond. Sums of seconds are not
/// that exact: at 50 Hz and 0.02 s every third sample came too early by their last digit.
class RowTimes {
  public:
    explicit RowTimes(double interval_s) : interval_us_(std::llround(interval_s * 1e6)) {}

    bool is_due(double time_s) {
        const std::int64_t time_us = std::llround(time_s * 1e6);
        first_us_ = samples_ == 0 ? time_us : first_us_;
        last_us_ = time_us;
        ++samples_;
        const bool due = rows_ == 0 || time_us >= next_us_;
        if (due) {
            next_us_ = time_us + interval_us_;
            ++rows_;
        }
        return due;
    }
    [[nodiscard]] std::size_t rows() const { return rows_; }
    /// Samples without a row, where the samples come so slowly that one would expect a row for each. Else empty.
    [[nodiscard]] std::string left_out() const {
        const bool is_slow = samples_ > 1 && 2.0 * static_cast<double>(last_us_ - first_us_) >
                                                 static_cast<double>(samples_ - 1) * static_cast<double>(interval_us_);
        return is_slow && rows_ < samples_
                   ? fmt::format(
                         "{} of {} samples come less than the interval of {} s after a row and have none; "
                         "--interval 0 gives a row for each",
                         samples_ - rows_, samples_, static_cast<double>(interval_us_) / 1e6)
                   : std::string();
    }

  private:
    std::int64_t interval_us_;
    std::int64_t first_us_ = 0;
    std::int64_t last_us_ = 0;
    std::int64_t next_us_ = 0;
    std::size_t samples_ = 0;
    std::size_t rows_ = 0;
};

/// The program's status of each row: from the recording, with F from the command line if it was given.
hal::ProgramStatus program_of(const RecordingReader& recording, const ReplayOptions& options) {
    hal::ProgramStatus program = recording.program();
    if (options.programmed_feed_mm_min) {
        program.programmed_feed_mm_s = static_cast<float>(*options.programmed_feed_mm_min / 60.0);
    }
    return program;
}

/// The same tick as in the loop, open: the recording goes in, estimates and the override that it would have commanded
/// come out.
int replay_table(const ReplayOptions& options) {
    const ToolSet tools(read_machine_parameters(options.machine), options.tools);
    const firmware::Parameters<float>& parameters = tools.parameters();
    RecordingReader recording(options.log, parameters.machine.encoder_counts_per_rev);
    if (!recording.has_force_sensor()) {
        tell_parameter_notes(parameters);
    }
    if (tools.source() != nullptr && !recording.has_tool()) {
        throw InputError(fmt::format("{}:1: expected the column tool with --tools", options.log));
    }
    firmware::ToolTick tick(parameters, tools.source());
    const ToolForces forces(tools);
    std::optional<AtomicFile> file;
    if (!options.output.empty()) {
        file.emplace(options.output);
    }
    // Without a file, an error in the last row must not leave half a table behind: rows go out when all are good.
    std::ostringstream held_back;
    std::ostream& out = file ? file->stream() : held_back;
    const bool is_one_tool = tools.source() == nullptr;
    ToolCells numbers(!is_one_tool);
    // What a tool's own tables add is shown for one tool alone: another may have other tables, or none.
    const firmware::ToolParameters<float> shown_tool =
        is_one_tool ? parameters.tool : firmware::ToolParameters<float>();
    RoughnessCells roughness(shown_tool.roughness);
    WideBandCells wide_band(is_one_tool && recording.has_force_sensor(), shown_tool);
    out << estimate_header;
    numbers.write_header(out);
    roughness.write_header(out);
    wide_band.write_header(out);
    out << '\n';
    Progress progress("replaying");
    RowTimes row_times(options.interval_s);
    ReplayFindings findings(parameters.machine.encoder_counts_per_rev);
    while (recording.next()) {
        progress.update(recording.fraction_read());
        tick.follow_tool(recording.tool(), hal::axes_rest(recording.sample().axis_velocity_mm_s));
        const hal::FeedOverride output =
            firmware::step_and_work(tick, recording.sample(), program_of(recording, options));
        const firmware::TickRecord record = firmware::tick_record(tick.of_tool(), output, 0);
        findings.follow(recording.sample(), record);
        if (row_times.is_due(recording.time_s())) {
            write_estimate_row(out, recording.time_s(), record, forces.of(record, tick.tool()));
            numbers.write(out, tick.tool());
            roughness.write(out, tick.of_tool().roughness());
            wide_band.write(out, tick.of_tool().wide_band());
            out << '\n';
        }
    }
    const std::size_t rows = row_times.rows();
    if (rows == 0) {
        throw InputError(fmt::format("{}: no rows after the header, expected a recording", options.log));
    }
    wide_band.tell_what_is_missing();
    for (const std::string& finding : recording.has_force_sensor() ? std::vector<std::string>() : findings.notes()) {
        fmt::print(stderr, "millforce: note: {}: {}\n", options.log, finding);
    }
    if (const std::string left_out = row_times.left_out(); !left_out.empty()) {
        fmt::print(stderr, "millforce: note: {}: {}\n", options.log, left_out);
    }
    if (const std::string note = numbers.note(); !note.empty()) {
        fmt::print(stderr, "millforce: note: {}: {}\n", options.log, note);
    }
    if (recording.has_one_force_only()) {
        fmt::print(stderr, "millforce: note: {}: fx_N and fy_N are used together, and one of them is missing\n",
                   options.log);
    }
    if (file) {
        file->commit();
        fmt::print("{}: {} rows\n{}{}", options.output, rows, roughness.summary(),
                   wide_band.summary(tick.of_tool().wide_band()));
    } else {
        std::cout << held_back.str();
    }
    return 0;
}

int replay(const ReplayOptions& options) {
    options.tools.require_one();
    std::vector<std::filesystem::path> inputs = options.tools.files();
    inputs.insert(inputs.end(), {options.log, options.machine, options.run_log});
    refuse_overwriting(options.output, inputs);
    if (!is_candump_log(options.log)) {
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
    return replay_candump({options.log, options.machine, options.tools, options.output, options.interface,
                           options.interval_s, options.run_log, options.pace});
}

}  // namespace

void add_replay(Command& program) {
    auto options = std::make_shared<ReplayOptions>();
    Command command = program.subcommand("replay", "Run estimation and control (open loop) on a recording");
    command.footer(
        "Columns of the recording: time_s, spindle_angle_rad, spindle_current_A, and AXIS_current_A and\n"
        "AXIS_velocity_mm_s for those of x, y, z that exist. A recording of 'simulate --record' also holds the index\n"
        "pulses and the program's feed, and its replay reproduces the simulation's estimates digit for digit.\n"
        "An empty cell of the estimates is \"no estimate\". A tool with a [roughness] table adds its prediction with\n"
        "the 95 % interval, and whether the cut is in the range of the model's tests.\n"
        "With a force sensor (fx_N, fy_N on the workpiece, in the machine's axes; currents may be missing) it adds "
        "the\n"
        "radial immersion from force drops and both depths from the force's shape, by the tool's tables\n"
        "[force_sensor], [force_drop] and [depth_shape].\n"
        "With --tools the column tool, or the log's tool frames, tell the number of the tool.\n"
        "A candump log ('candump -l', 'candump -L', 'millforce run --record') is decoded with the machine's [bus] "
        "tables.\n"
        "What was recorded during 'millforce run', from its start on, gives the estimates of that run digit for "
        "digit.");
    command.option("log", options->log, "Recording: CSV, or a candump log").required().value_name("LOG");
    command.option("--machine", options->machine, "Machine parameters").required().value_name("M.toml");
    add_tools(command, options->tools);
    command.option("-o,--output", options->output, "Estimates; default: standard output").value_name("OUT.csv");
    command
        .option("--programmed-feed", options->programmed_feed_mm_min,
                "Programmed feed F in mm/min, for the override; default: from the recording, else unknown")
        .within(0.0, 1e6);
    command.option("--interval", options->interval_s, "Time between two rows in s; 0: a row for each sample")
        .within(0.0, 1e6)
        .shows_default();
    command.option("--interface", options->interface, "Interface to replay, if a candump log has several")
        .value_name("IFACE");
    command
        .option("--verify", options->run_log,
                "Compare with the log of 'millforce run --log'; exit code 1 if one bit of one tick differs")
        .value_name("RUN.jsonl");
    add_bus_pace(command, options->pace);
    command.on_run([options] { return replay(*options); });
}

}  // namespace millforce::host
