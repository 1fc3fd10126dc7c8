// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands/command_line.hpp"

namespace millforce::host {

/// The subcommands that a machine needs. Each adds itself to the program.
void add_run(Command& program);
void add_serve(Command& program);
void add_replay(Command& program);
void add_calibrate(Command& program);
void add_estimate(Command& program);
void add_parameters(Command& program);
void add_import(Command& program);
void add_check(Command& program);
void add_init(Command& program);
void add_commission(Command& program);
void add_telemetry(Command& program);
void add_gateway(Command& program);
void add_shop(Command& program);
void add_map_commands(Command& program);

}  // namespace millforce::host
