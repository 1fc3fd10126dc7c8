// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "files/input_error.hpp"
#include "import/import_recording.hpp"

namespace millforce::host {

namespace {

struct ImportOptions {
    ImportSettings settings;
    bool dry_run = false;
};

int import_files(const ImportOptions& options) {
    ImportSettings settings = options.settings;
    if (options.dry_run) {
        settings.output.clear();
    } else if (settings.output.empty()) {
        throw InputError("--output: missing, expected a file to write, or --dry-run (see 'millforce import --help')");
    }
    const ImportedRecording recording = import_recording(settings);
    if (!options.dry_run) {
        fmt::print("{}: {} rows\n", settings.output, recording.steps.rows());
    }
    fmt::print("{}", import_report(recording));
    return 0;
}

}  // namespace

void add_import(Command& program) {
    auto options = std::make_shared<ImportOptions>();
    ImportSettings& settings = options->settings;
    Command command = program.subcommand("import", "Turn measurements of other programs into a recording");
    command.footer(
        "MAP.toml has a table for each column of the recording: where it comes from, and in which unit. For example\n"
        "    [time_s]\n"
        "    source = \"Time\"                 # the column's name; or source_number = 1\n"
        "    unit = \"ms\"\n"
        "    [spindle_angle_rad]\n"
        "    source = \"Spindle position\"\n"
        "    unit = \"deg\"\n"
        "    wrap = 360\n"
        "    [x_current_A]\n"
        "    source = \"X load\"\n"
        "    unit = \"%\"\n"
        "    rated_A = 11.5\n"
        "    [x_velocity_mm_s]\n"
        "    source = \"X\"\n"
        "    derived_from = \"position\"       # in mm; its slope over smoothing_s\n"
        "All keys, and an example of each format: firmware/program/import/README.md. Without a map, the columns of a\n"
        "table that have the recording's names are taken.\n"
        "--dry-run shows what was understood: rate, gaps, and each column's range and course, and names what cannot "
        "be\n"
        "right, with the likely mistake in a unit.\n"
        "Several files are parts of one recording: time continues from one file to the next.");
    command.option("files", settings.files, "Measurements").required().value_name("FILE");
    command.output_file("-o,--output", settings.output, "The recording").value_name("RECORDING.csv");
    command.option("--map", settings.map, "What the columns are").value_name("MAP.toml");
    command.choice<SourceFormat>("--format", settings.format,
                                 "Default: as the map says, else by the file's first characters",
                                 {{"csv", SourceFormat::csv},
                                  {"odrive", SourceFormat::odrive},
                                  {"sinumerik", SourceFormat::sinumerik},
                                  {"halsampler", SourceFormat::halsampler},
                                  {"candump", SourceFormat::candump}});
    command.flag("--dry-run", options->dry_run, "Write nothing");
    const Option rate =
        command
            .option("--rate", settings.resampling.rate_hz,
                    "Rows at this rate in Hz, with the last value of each column; default: a row for each record")
            .value_name("HZ")
            .within(0.1, 1e6);
    command
        .option("--hold", settings.resampling.hold_s,
                "With --rate: hold a value for at most this time in s; then its cell is empty")
        .value_name("S")
        .within(0.0001, 3600.0)
        .shows_default()
        .needs(rate);
    command.on_run([options] { return import_files(*options); });
}

}  // namespace millforce::host
