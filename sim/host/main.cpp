#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "host/commands.hpp"

int main(int argc, char** argv) {
    using namespace millforce::sim;
    remove_unfinished_files_on_interrupt();
    CLI::App app{"millforce - sensorless force control for milling"};
    app.set_version_flag("--version", "millforce " MILLFORCE_VERSION);
    app.require_subcommand(1);
    int exit_code = 0;
    add_simulate(app, exit_code);
    add_replay(app, exit_code);
    add_calibrate(app, exit_code);
    add_estimate(app, exit_code);
    add_bench(app, exit_code);
    add_parameters(app, exit_code);
    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const InputError& error) {
        fmt::print(stderr, "millforce: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "millforce: {}\n", error.what());
        return 2;
    }
}
