// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "commands/command_line.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Who watches a live controller; by default nobody.
struct WatchOptions {
    bool view = false;
    std::optional<std::uint64_t> web_port;
    std::string udp_json;
    std::string mcap;
    std::string jobs;
    std::string gateway;
};

/// --view, --web and --udp-json.
void add_live_watch(Command& command, WatchOptions& options);
/// These, --mcap, --jobs and --gateway.
void add_watch(Command& command, WatchOptions& options);

/// Opens all that was asked for. `title`: what is watched, e.g. "can0". `recorder`: of the run's page, or null. Throws
/// InputError.
[[nodiscard]] std::unique_ptr<TelemetryHub> watch(const WatchOptions& options, const ToolSet& tools,
                                                  const std::string& title, std::unique_ptr<TelemetrySink> recorder);

}  // namespace millforce::host
