#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

#include "control/cut_state.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/parameter_files.hpp"
#include "files/progress.hpp"
#include "host/commands.hpp"
#include "loop/override_source.hpp"
#include "loop/recording.hpp"

namespace millforce::sim {

namespace {

struct ReplayOptions {
    std::string log;
    std::string machine;
    std::string tool;
    std::string output;
    double programmed_feed_mm_min = 0.0;
};

constexpr std::string_view header =
    "time_s,state,tangential_force_N,feed_force_N,radial_immersion,radial_immersion_sd,axial_depth_mm,"
    "axial_depth_sd_mm,peak_force_N,force_limit_N,override\n";

void write_row(std::ostream& out, double time_s, const TracePoint& p, float ratio) {
    const double columns[] = {p.tangential_force_N, p.feed_force_N,      p.radial_immersion,
                              p.radial_immersion_sd, p.axial_depth_mm,   p.axial_depth_sd_mm,
                              p.peak_force_N,       p.force_limit_N,     static_cast<double>(ratio)};
    std::string line = CsvWriter::cell(time_s);
    line += ',';
    line += control::name(static_cast<control::CutState>(p.state));
    for (const double value : columns) {
        line += ',';
        line += CsvWriter::cell(static_cast<double>(static_cast<float>(value)));
    }
    out << line << '\n';
}

/// The same tick as in the loop, open: the recording goes in, estimates and the override that it would have commanded
/// come out, one row per tooth period.
int replay(const ReplayOptions& options) {
    const auto parameters = read_parameters(options.machine, options.tool);
    RecordingReader recording(options.log, static_cast<std::uint32_t>(parameters.machine.encoder_counts_per_rev));
    MillforceController controller(parameters);
    std::optional<AtomicFile> file;
    if (!options.output.empty()) {
        file.emplace(options.output);
    }
    std::ostream& out = file ? file->stream() : std::cout;
    out << header;
    Progress progress("replaying");
    std::size_t rows = 0;
    double next_row_s = -1e18;
    while (recording.next()) {
        hal::ProgramStatus program;
        program.programmed_feed_mm_s = static_cast<float>(options.programmed_feed_mm_min / 60.0);
        const hal::FeedOverride output = controller.step(recording.sample(), program);
        if (recording.time_s() >= next_row_s) {
            TracePoint point;
            controller.describe(point);
            write_row(out, recording.time_s(), point, output.ratio);
            next_row_s = recording.time_s() + 0.02;
            ++rows;
        }
    }
    if (rows == 0) {
        throw InputError(fmt::format("{}: no rows after the header, expected a recording", options.log));
    }
    if (file) {
        file->commit();
        fmt::print("{}: {} rows\n", options.output, rows);
    }
    return 0;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand("replay", "Estimation and control (open loop) on a recording");
    command->add_option("log", options->log, "Recording (CSV)")->required()->type_name("LOG.csv");
    command->add_option("--machine", options->machine, "Machine parameters")->required()->type_name("M.toml");
    command->add_option("--tool", options->tool, "Tool parameters")->required()->type_name("T.toml");
    command->add_option("-o,--output", options->output, "Estimates (CSV); default: standard output");
    command->add_option("--programmed-feed", options->programmed_feed_mm_min,
                        "F of the program in mm/min, for the override; 0: not known")
        ->check(CLI::Range(0.0, 1e6));
    command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace millforce::sim
