// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_block_file.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"

namespace millforce::host {

namespace {

struct ParametersOptions {
    std::string machine;
    ToolChoice tools;
    std::string block_to_write;
    std::string block_to_read;
};

void write_block(const ParametersOptions& options) {
    options.tools.require_one();
    if (!options.tools.is_folder()) {
        write_parameter_block(options.block_to_write, read_parameters(options.machine, options.tools.file));
        fmt::print("{}: {} bytes, {} values\n", options.block_to_write, firmware::block_bytes,
                   firmware::parameter_count);
        return;
    }
    const std::vector<NumberedTool> tools = read_tool_folder(options.tools.folder);
    const std::size_t bytes =
        write_tools_block(options.block_to_write, read_machine_parameters(options.machine), tools);
    fmt::print("{}: {} bytes, tools", options.block_to_write, bytes);
    for (const NumberedTool& tool : tools) {
        fmt::print(" {}", tool.number);
    }
    fmt::print("\n");
}

}  // namespace

void add_parameters(Command& program) {
    auto options = std::make_shared<ParametersOptions>();
    Command command = program.subcommand(
        "parameters",
        "Print every key of machine.toml and tool.toml as Markdown; make or print a target's flash block");
    Option write =
        command.output_file("--write-block", options->block_to_write, "Make a target's flash block from the files")
            .value_name("FILE");
    Option machine = command.option("--machine", options->machine, "For --write-block").value_name("M.toml");
    Option tool = command.option("--tool", options->tools.file, "For --write-block").value_name("T.toml");
    Option tools = command
                       .option("--tools", options->tools.folder,
                               "For --write-block, in place of --tool: folder of up to 16 tools T<number>.toml")
                       .value_name("FOLDER");
    Option read = command.option("--read-block", options->block_to_read, "Print a target's flash block as TOML")
                      .value_name("FILE");
    write.needs(machine).excludes(read);
    machine.needs(write);
    tool.needs(write);
    tools.needs(write);
    command.on_run([options] {
        if (!options->block_to_write.empty()) {
            write_block(*options);
        } else if (!options->block_to_read.empty()) {
            write_parameters_as_toml(std::cout, read_parameter_block(options->block_to_read));
        } else {
            fmt::print("{}", parameter_documentation());
        }
        return 0;
    });
}

}  // namespace millforce::host
