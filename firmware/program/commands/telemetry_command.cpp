// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

void add_telemetry(Command& program) {
    Command command = program.subcommand("telemetry", "Print the fields of the live telemetry as a table");
    command.footer(
        "The fields of run|serve --view, --web, --udp-json and --mcap, and of the metrics, with unit and meaning, in\n"
        "Markdown.");
    command.on_run([] {
        fmt::print("{}", telemetry_table());
        return 0;
    });
}

}  // namespace millforce::host
