// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>

#include "check/check_parameters.hpp"
#include "check/check_recording.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/parameter_notes.hpp"

namespace millforce::host {

namespace {

struct CheckOptions {
    std::string machine;
    std::string tool;
    std::string recording;
};

int check(const CheckOptions& options) {
    const auto parameters = read_parameters(options.machine, options.tool);
    read_machine_bus(options.machine);  // refuses settings that do not fit together
    Findings findings = check_parameters(parameters);
    for (const std::string& note : parameter_notes(parameters)) {
        findings.push_back({Severity::note, note, "x.K_x4_N_per_A"});
    }
    if (!options.recording.empty()) {
        append(findings, check_recording(options.recording, parameters));
    }
    for (const Finding& finding : findings) {
        fmt::print("{}\n", line_of(finding));
    }
    fmt::print("{}\n", count_of(findings));
    return is_something_wrong(findings) ? 1 : 0;
}

}  // namespace

void add_check(Command& program) {
    auto options = std::make_shared<CheckOptions>();
    Command command = program.subcommand("check", "Look for the usual first mistakes in the files and in a recording");
    command.footer(
        "One line for each finding: error (cannot be right), warning (likely wrong) or note (could not be judged), "
        "and\n"
        "the key or column to look at. The recording should hold some seconds of each: the spindle turning with the\n"
        "axes at rest, steady moves of each axis to and fro in air, and a cut.\n"
        "Exit code 1: an error or a warning.");
    command.option("machine", options->machine, "Machine parameters").required().value_name("MACHINE.toml");
    command.option("tool", options->tool, "Tool parameters").required().value_name("TOOL.toml");
    command.option("recording", options->recording, "Recording, as for 'millforce replay'").value_name("RECORDING.csv");
    command.on_run([options] { return check(*options); });
}

}  // namespace millforce::host
