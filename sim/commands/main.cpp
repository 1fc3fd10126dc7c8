// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/plant_commands.hpp"
#include "files/atomic_file.hpp"

namespace {

using namespace millforce;
using namespace millforce::sim;

int run(int argc, char** argv) {
    CLI::App app{"Sensorless force control for milling", "millforce"};
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done; 1 done, and a stated bound does not hold; 2 bad usage or input.\n"
        "'millforce COMMAND --help' tells more about a command.");
    int exit_code = 0;
    add_simulate(app, exit_code);
    add_ensemble(app, exit_code);
    host::add_replay(app, exit_code);
    host::add_run(app, exit_code);
    host::add_calibrate(app, exit_code);
    host::add_estimate(app, exit_code);
    add_reproduce(app, exit_code);
    add_cut_table(app, exit_code);
    add_bench(app, exit_code);
    host::add_serve(app, exit_code);
    add_plant(app, exit_code);
    host::add_parameters(app, exit_code);
    host::set_common_rules(app, "millforce " MILLFORCE_VERSION);
    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app.exit(error);
        }
        fmt::print(stderr, "millforce: {}\n", host::usage_error(app, argc, argv, error.what()));
        return 2;
    }
}

}  // namespace

int main(int argc, char** argv) {
    host::remove_unfinished_files_on_interrupt();
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "millforce: %s\n", error.what());
        return 2;
    }
}
