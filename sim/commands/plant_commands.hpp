// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "commands/command_line.hpp"

namespace millforce::sim {

/// The subcommands that need a simulated machine. Each adds itself to the program and, when chosen, runs and sets the
/// exit code: 0 done; 1 done, and a stated bound does not hold; 2 bad usage or input (by throwing InputError).
void add_simulate(host::Command& program);
void add_preview(host::Command& program);
void add_plant(host::Command& program);
void add_ensemble(host::Command& program);
void add_kinds(host::Command& program);
void add_bench(host::Command& program);
/// Below `bench`, whose own function is called after this one: `exit_code` tells it that this one has run.
void add_bench_control(host::Command& bench, const std::shared_ptr<std::optional<int>>& exit_code);
void add_reproduce(host::Command& program);
void add_cut_table(host::Command& program);

}  // namespace millforce::sim
