// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace millforce::host {

/// GATEWAY.toml. Paths may be empty: then that part is left out.
struct GatewaySettings {
    std::string machine;  ///< in the topics
    std::string topic;    ///< where all topics begin
    std::string host;
    int port = 0;
    std::string username;
    std::string password;
    std::string ca_file;           ///< certificates that the broker's is checked by; empty: no TLS
    std::string certificate_file;  ///< of this client, with its key
    std::string key_file;
    std::string telemetry_socket;  ///< of `run --gateway` and `serve --gateway`
    std::filesystem::path jobs;    ///< folder of `--jobs`
    std::filesystem::path tools;   ///< folder of `--tools`
    std::filesystem::path maps;    ///< folder for part maps
};

/// Throws InputError: a key that is missing, unknown or out of its range, a folder that does not exist, a password
/// without TLS to another computer.
[[nodiscard]] GatewaySettings read_gateway_settings(const std::string& file);

}  // namespace millforce::host
