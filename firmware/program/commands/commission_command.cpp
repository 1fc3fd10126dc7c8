// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/machine_on_bus.hpp"
#include "commission/commission.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

struct CommissionCommandOptions {
    std::string interface;
    std::string session = "commissioning";
    std::string answers;
    std::vector<std::string> pairs;
    std::vector<std::string> recordings;
    std::vector<std::string> repeated;
    BusPace pace{};
};

void require_step(const std::string& option, const std::string& step) {
    const std::vector<std::string>& steps = commission_steps();
    if (std::find(steps.begin(), steps.end(), step) == steps.end()) {
        throw InputError(fmt::format("{} {}: expected one of {}", option, step, fmt::join(steps, ", ")));
    }
}

/// STEP=FILE.csv
void add_recording(CommissionOptions& options, const std::string& pair) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == pair.size()) {
        throw InputError(fmt::format("--recording {}: expected STEP=FILE.csv, e.g. air=air.csv", pair));
    }
    const std::string step = pair.substr(0, equals);
    require_step("--recording", step);
    options.recordings[step].emplace_back(pair.substr(equals + 1));
}

int run_commission(const CommissionCommandOptions& options) {
    CommissionOptions chosen;
    chosen.session = options.session;
    for (const std::string& pair : options.recordings) {
        add_recording(chosen, pair);
    }
    for (const std::string& step : options.repeated) {
        require_step("--repeat", step);
    }
    chosen.repeated = options.repeated;
    if (!options.interface.empty() && !chosen.recordings.empty()) {
        throw InputError("--recording: the machine is on a CAN interface; expected one or the other");
    }
    Answers answers(options.answers, options.pairs);
    if (isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0) {
        answers.ask_on(std::cin, std::cout);
    }
    std::unique_ptr<LiveMachine> live;
    if (!options.interface.empty()) {
        live = std::make_unique<MachineOnInterface>(options.interface, options.pace);
    }
    return commission(chosen, answers, live.get(), std::cout);
}

}  // namespace

void add_commission(Command& program) {
    auto options = std::make_shared<CommissionCommandOptions>();
    Command command = program.subcommand(
        "commission", "Measure a machine step by step, and write its machine.toml, tool.toml and a page");
    command.footer(
        "Finds the drives, then takes in turn: the spindle idling, air cuts, a standard cut, a second one to "
        "validate.\n"
        "It writes a program for each into the session's folder and says when to run it. A step ends by itself when "
        "it\n"
        "has what its fit takes. Ctrl-C at any time; the same command goes on from there.\n"
        "Without an interface the machine is recorded by another program: 'millforce import' makes recordings of\n"
        "LinuxCNC's sampler. Each is given with --recording STEP=FILE.csv.\n"
        "The override stays the operator's all the time.\n"
        "Exit code 1: something is to be repeated, or not recorded yet.");
    command.option("interface", options->interface, "CAN interface, e.g. can0; none: --recording").value_name("IFACE");
    command.option("--session", options->session, "Folder of the session").value_name("DIR").shows_default();
    command.option("--answers", options->answers, "Answers").value_name("FILE.toml");
    command.option("--set", options->pairs, "An answer").value_name("KEY=VALUE");
    command.option("--recording", options->recordings, "Recording of a step").value_name("STEP=FILE.csv");
    command.option("--repeat", options->repeated, "Set the recordings of a step aside and do it again")
        .value_name("STEP");
    add_bus_pace(command, options->pace);
    command.on_run([options] { return run_commission(*options); });
}

}  // namespace millforce::host
