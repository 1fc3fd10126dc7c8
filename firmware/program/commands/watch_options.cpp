// SPDX-License-Identifier: Apache-2.0
#include "commands/watch_options.hpp"

#include <utility>
#include <vector>

#include "live/terminal_view.hpp"
#include "live/udp_json.hpp"

namespace millforce::host {

void add_watch(Command& command, WatchOptions& options) {
    command.flag("--view", options.view, "Show load, override, estimates, state and events on the terminal");
    command.option("--udp-json", options.udp_json, "Send each tick as JSON, for PlotJuggler's UDP server (port 9870)")
        .value_name("HOST:PORT");
}

std::unique_ptr<TelemetryHub> watch(const WatchOptions& options, const ToolSet& tools, const std::string& title) {
    std::vector<std::unique_ptr<TelemetrySink>> sinks;
    if (options.view) {
        sinks.push_back(std::make_unique<TerminalView>(title));
    }
    if (!options.udp_json.empty()) {
        sinks.push_back(std::make_unique<UdpJson>(options.udp_json));
    }
    return std::make_unique<TelemetryHub>(tools, std::move(sinks));
}

}  // namespace millforce::host
