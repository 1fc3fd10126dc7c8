// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/plant_commands.hpp"
#include "files/atomic_file.hpp"
#include "files/console.hpp"

namespace {

int run(int argc, char** argv) {
    using namespace millforce;
    host::CommandLine line("millforce", "Sensorless force control for milling", "millforce " MILLFORCE_VERSION);
    host::Command program = line.root();
    program.footer(
        "Exit codes: 0 done; 1 done, and a stated bound does not hold; 2 bad usage or input.\n"
        "'millforce COMMAND --help' describes a command.");
    // In the order of firmware/program/README.md.
    sim::add_simulate(program);
    sim::add_preview(program);
    sim::add_ensemble(program);
    sim::add_kinds(program);
    host::add_run(program);
    host::add_serve(program);
    host::add_map_commands(program);
    sim::add_plant(program);
    host::add_replay(program);
    host::add_import(program);
    host::add_init(program);
    host::add_commission(program);
    host::add_check(program);
    host::add_telemetry(program);
    host::add_gateway(program);
    host::add_shop(program);
    host::add_calibrate(program);
    host::add_estimate(program);
    sim::add_reproduce(program);
    sim::add_cut_table(program);
    host::add_parameters(program);
    sim::add_bench(program);
    return line.run(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
    millforce::host::remove_unfinished_files_on_interrupt();
    try {
        const int exit_code = run(argc, argv);
        if (!millforce::host::flush_standard_output()) {
            std::fprintf(stderr, "millforce: standard output cannot be written\n");
            return 2;
        }
        return exit_code;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "millforce: out of memory\n");
        return 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "millforce: %s\n", error.what());
        return 2;
    }
}
