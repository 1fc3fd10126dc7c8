// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "check/check_parameters.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commission/answers.hpp"
#include "commission/first_files.hpp"
#include "files/input_error.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

struct InitOptions {
    std::string machine;
    std::string tool;
    std::string answers;
    std::vector<std::string> pairs;
    bool force = false;
};

void refuse_existing(const InitOptions& options, const std::string& file) {
    if (!options.force && !file.empty() && std::filesystem::exists(file)) {
        throw InputError(fmt::format("{}: exists already; expected a new file, or --force to write over it", file));
    }
}

/// What `millforce check` would say.
int check_written(const InitOptions& options) {
    if (options.machine.empty() || options.tool.empty()) {
        return 0;
    }
    read_machine_bus(options.machine);
    const Findings findings = check_parameters(read_parameters(options.machine, options.tool));
    for (const Finding& finding : findings) {
        fmt::print("{}\n", line_of(finding));
    }
    fmt::print("check: {}\n", count_of(findings));
    return is_something_wrong(findings) ? 1 : 0;
}

int init(InitOptions options) {
    if (options.machine.empty() && options.tool.empty()) {
        options.machine = "machine.toml";
        options.tool = "tool.toml";
    }
    refuse_existing(options, options.machine);
    refuse_existing(options, options.tool);
    Answers answers(options.answers, options.pairs);
    if (isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0) {
        fmt::print("Enter takes the value in brackets; Ctrl-C writes nothing.\n");
        std::fflush(stdout);
        answers.ask_on(std::cin, std::cout);
    }
    std::optional<FileDraft> machine;
    std::optional<FileDraft> tool;
    if (!options.machine.empty()) {
        machine = first_machine_file(answers);
    }
    std::ostringstream advice;  // a refusal is one line alone
    if (!options.tool.empty()) {
        tool = first_tool_file(answers, answers.asks() ? std::cout : advice);
    }
    // A file of answers may be for both files, of which one is written.
    answers.require_all(!options.machine.empty() && !options.tool.empty());
    std::cout << advice.str() << std::flush;
    if (machine) {
        machine->save(options.machine);
        fmt::print("{}: written\n", options.machine);
    }
    if (tool) {
        tool->save(options.tool);
        fmt::print("{}: written\n", options.tool);
    }
    return check_written(options);
}

}  // namespace

void add_init(Command& program) {
    auto options = std::make_shared<InitOptions>();
    Command command = program.subcommand("init", "Write a first machine.toml and tool.toml from data sheets");
    command.footer(
        "Without --machine and --tool both are written, here. On a terminal it asks for what is not given; elsewhere\n"
        "every answer without a usual value must be given, and a missing one is named. A file of answers is TOML with\n"
        "the same keys:\n"
        "  millforce init tool.diameter_mm=10 tool.teeth=4 tool.workpiece=steel …\n"
        "The values are from data sheets and known to 10 %: 'millforce commission' measures them.\n"
        "Exit code 1: 'millforce check' would find something in the files.");
    command.option("--machine", options->machine, "Machine file to write").value_name("M.toml");
    command.option("--tool", options->tool, "Tool file to write").value_name("T.toml");
    command.option("--answers", options->answers, "Answers").value_name("FILE.toml");
    command.flag("--force", options->force, "Write over files that exist");
    command.option("answer", options->pairs, "Answers").value_name("KEY=VALUE");
    command.on_run([options] { return init(*options); });
}

}  // namespace millforce::host
