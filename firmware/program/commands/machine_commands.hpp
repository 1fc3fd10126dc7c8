// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace millforce::host {

/// The subcommands that a machine needs. Each adds itself to the program and, when chosen, runs and sets the exit code:
/// 0 done; 1 done, and a stated bound does not hold; 2 bad usage or input (by throwing InputError).
void add_run(CLI::App& app, int& exit_code);
void add_serve(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_estimate(CLI::App& app, int& exit_code);
void add_parameters(CLI::App& app, int& exit_code);

}  // namespace millforce::host
