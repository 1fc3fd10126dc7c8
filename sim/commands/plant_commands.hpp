// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace millforce::sim {

/// The subcommands that need a simulated machine. Each adds itself to the program and, when chosen, runs and sets the
/// exit code: 0 done; 1 done, and a stated bound does not hold; 2 bad usage or input (by throwing InputError).
void add_simulate(CLI::App& app, int& exit_code);
void add_plant(CLI::App& app, int& exit_code);
void add_ensemble(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_reproduce(CLI::App& app, int& exit_code);
void add_cut_table(CLI::App& app, int& exit_code);

}  // namespace millforce::sim
