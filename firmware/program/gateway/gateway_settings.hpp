// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace millforce::host {

/// The table [broker].
struct BrokerSettings {
    std::string host;
    int port = 0;
    std::string username;
    std::string password;
    std::string ca_file;           ///< certificates that the broker's is checked by; empty: no TLS
    std::string certificate_file;  ///< of this client, with its key
    std::string key_file;
};

/// GATEWAY.toml. Paths may be empty: then that part is left out.
struct GatewaySettings {
    std::string machine;  ///< in the topics
    std::string topic;    ///< where all topics begin
    BrokerSettings broker{};
    std::string telemetry_socket;  ///< of `run --gateway` and `serve --gateway`
    std::filesystem::path jobs;    ///< folder of `--jobs`
    std::filesystem::path tools;   ///< folder of `--tools`
    std::filesystem::path maps;    ///< folder for part maps
};

/// Throws InputError: a key that is missing, unknown or out of its range, a folder that does not exist, a password
/// without TLS to another computer.
[[nodiscard]] GatewaySettings read_gateway_settings(const std::string& file);

/// SHOP.toml.
struct ShopSettings {
    std::string topic;  ///< where all topics begin
    BrokerSettings broker{};
};

/// Throws InputError, as read_gateway_settings().
[[nodiscard]] ShopSettings read_shop_settings(const std::string& file);

/// A level of a topic that names a machine: 1 to 64 letters, digits, '-' and '_', and not "all".
[[nodiscard]] bool is_name_of_machine(std::string_view level);

}  // namespace millforce::host
