// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "commands/scenario_info.hpp"
#include "daemon/unix_socket.hpp"
#include "files/results_folder.hpp"
#include "linuxcnc/linuxcnc_plant.hpp"
#include "loop/bounds.hpp"
#include "report/report.hpp"
#include "report/summary.hpp"

namespace millforce::sim {

namespace {

struct PlantOptions {
    std::string scenario;
    std::string socket;
    std::string out = "out";
    bool once = false;
};

/// Within what a machine can do; a NaN is not.
bool is_sound(const millforce_plant_command& command) {
    const auto is_within = [](double value, double largest) { return value >= -largest && value <= largest; };
    constexpr double largest_position_mm = 1e5;
    constexpr double largest_spindle_rev_s = 2000.0;
    bool sound =
        command.period_s >= 1e-5 && command.period_s <= 0.1 && is_within(command.spindle_rev_s, largest_spindle_rev_s);
    for (const double position_mm : command.position_mm) {
        sound = sound && is_within(position_mm, largest_position_mm);
    }
    return sound;
}

bool exchange(host::UnixServer& server, LinuxCncPlant& plant) {
    const auto bytes = server.receive();
    millforce_plant_command command{};
    if (bytes.size() != sizeof command) {
        server.drop_peer();
        return false;
    }
    std::memcpy(&command, bytes.data(), sizeof command);
    if (!is_sound(command)) {
        fmt::print(stderr, "millforce: invalid command: is millforce_plant of another version?\n");
        server.drop_peer();
        return false;
    }
    const millforce_plant_reply reply = plant.step(command);
    server.send({reinterpret_cast<const std::uint8_t*>(&reply), sizeof reply});
    return true;
}

/// Returns whether the run keeps the bounds.
bool report(const Scenario& scenario, const std::filesystem::path& out, const RunResult& result) {
    const ScenarioInfo info = info_of(scenario, {});
    const std::vector<RunResult> results{result};
    fmt::print("{}", summary_table(info, results));
    write_report(out, info, results);
    fmt::print("\nreport: {}\n", (out / "report.html").string());
    std::fflush(stdout);
    return bounds_hold(result.figures);
}

int run_plant(const PlantOptions& options) {
    const Scenario scenario = read_scenario(options.scenario);
    const std::filesystem::path out = host::results_folder(options.out, "summary.json");
    host::UnixServer server(options.socket);
    LinuxCncPlant plant(scenario);
    bool is_good = true;
    while (server.wait_for_peer()) {
        bool is_there = true;
        while (is_there) {
            is_there = exchange(server, plant);
            if (!is_there) {
                plant.disconnect();
            }
            if (const auto result = plant.take_result()) {
                is_good = report(scenario, out, *result);
            }
        }
        if (options.once) {
            break;
        }
    }
    return is_good ? 0 : 1;
}

}  // namespace

void add_plant(host::Command& program) {
    auto options = std::make_shared<PlantOptions>();
    host::Command command = program.subcommand("plant", "Run a simulated machine and workpiece behind a real LinuxCNC");
    command.footer(
        "LinuxCNC's component millforce_plant connects and sends the commanded positions (sim/linuxcnc/run starts all "
        "of\n"
        "it). Each run from spindle start to spindle stop gives a summary and a report.\n"
        "Exit code 1: the last run broke a bound, as with 'simulate'.");
    command.option("scenario", options->scenario, "Machine, tool, material and stock; the moves are LinuxCNC's")
        .required()
        .value_name("SCENARIO.toml");
    command.option("socket", options->socket, "Path of the socket to create").required().value_name("SOCKET");
    command.option("--out", options->out, "Folder for summary.json, trace.csv and report.html")
        .value_name("DIR")
        .shows_default();
    command.flag("--once", options->once, "Exit when LinuxCNC disconnects");
    command.on_run([options] { return run_plant(*options); });
}

}  // namespace millforce::sim
