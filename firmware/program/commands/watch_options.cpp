// SPDX-License-Identifier: Apache-2.0
#include "commands/watch_options.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "files/console.hpp"
#include "files/input_error.hpp"
#include "live/job_files.hpp"
#include "live/mcap_file.hpp"
#include "live/terminal_view.hpp"
#include "live/udp_json.hpp"
#include "live/unix_json.hpp"
#include "live/web_server.hpp"

namespace millforce::host {

void add_live_watch(Command& command, WatchOptions& options) {
    command.flag("--view", options.view, "Show load, override, estimates, state and events on the terminal");
    command
        .option("--web", options.web_port,
                "Show strips over time to browsers on this computer, at http://127.0.0.1:PORT/, and metrics to\n"
                "Prometheus at /metrics; 0: any free port")
        .value_name("PORT");
    command.option("--udp-json", options.udp_json, "Send each tick as JSON, for PlotJuggler's UDP server (port 9870)")
        .value_name("HOST:PORT");
}

void add_watch(Command& command, WatchOptions& options) {
    add_live_watch(command, options);
    command.output_file("--mcap", options.mcap, "Write the telemetry as MCAP, for Foxglove and PlotJuggler")
        .value_name("FILE.mcap");
    command.option("--jobs", options.jobs, "Write a report of each job as a JSON file").value_name("FOLDER");
    command.option("--gateway", options.gateway, "Tell 'millforce gateway' the state and events").value_name("SOCKET");
}

std::unique_ptr<TelemetryHub> watch(const WatchOptions& options, const ToolSet& tools, const std::string& title,
                                    std::unique_ptr<TelemetrySink> recorder) {
    std::vector<std::unique_ptr<TelemetrySink>> sinks;
    if (recorder != nullptr) {
        sinks.push_back(std::move(recorder));
    }
    if (options.view) {
        sinks.push_back(std::make_unique<TerminalView>(title));
    }
    if (options.web_port) {
        if (*options.web_port > UINT16_MAX) {
            throw InputError(fmt::format("--web: {}, expected a port from 0 to 65535", *options.web_port));
        }
        auto server = std::make_unique<WebServer>(static_cast<std::uint16_t>(*options.web_port), title);
        print_line(stderr, fmt::format("millforce: http://127.0.0.1:{}/ shows the telemetry", server->port()));
        sinks.push_back(std::move(server));
    }
    if (!options.udp_json.empty()) {
        sinks.push_back(std::make_unique<UdpJson>(options.udp_json));
    }
    if (!options.mcap.empty()) {
        sinks.push_back(std::make_unique<McapFile>(options.mcap));
    }
    if (!options.jobs.empty()) {
        sinks.push_back(std::make_unique<JobFiles>(options.jobs));
    }
    if (!options.gateway.empty()) {
        sinks.push_back(std::make_unique<UnixJson>(options.gateway));
    }
    return std::make_unique<TelemetryHub>(tools, std::move(sinks));
}

}  // namespace millforce::host
