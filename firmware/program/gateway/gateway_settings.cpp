// SPDX-License-Identifier: Apache-2.0
#include "gateway/gateway_settings.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "files/text_lines.hpp"
#include "files/toml_reader.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view letters_of_levels = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";

/// A level of a topic: no separator, no wildcard.
std::string level(TomlFile::Table& table, const std::string& key, std::optional<std::string> fallback = {}) {
    std::string text = table.text(key, std::move(fallback));
    if (!is_name_of_machine(text)) {
        table.fail(key, "expected 1 to 64 letters, digits, '-' and '_', and not \"all\"");
    }
    return text;
}

std::string folder(TomlFile::Table& table, const std::string& key) {
    std::string text = table.text(key, "");
    if (std::error_code error; !text.empty() && !std::filesystem::is_directory(text, error)) {
        table.fail(key, "expected a folder");
    }
    return text;
}

std::string first_line_of(const std::string& file) {
    TextLines lines(file);
    if (!lines.next() || lines.text().empty()) {
        throw InputError(fmt::format("{}: expected a password in the first line", file));
    }
    return lines.text();
}

BrokerSettings read_broker(TomlFile::Table broker) {
    BrokerSettings settings;
    constexpr int port_with_tls = 8883;
    constexpr int port_without = 1883;
    settings.host = broker.text("host");
    settings.ca_file = broker.text("ca_file", "");
    settings.certificate_file = broker.text("certificate_file", "");
    settings.key_file = broker.text("key_file", "");
    const int usual_port = settings.ca_file.empty() ? port_without : port_with_tls;
    settings.port = static_cast<int>(broker.integer("port", 1, 65535, usual_port));
    settings.username = broker.text("username", "");
    const std::string password_file = broker.text("password_file", "");
    broker.reject_unknown_keys();
    const bool is_here = settings.host == "localhost" || settings.host == "127.0.0.1" || settings.host == "::1";
    if (!password_file.empty() && settings.ca_file.empty() && !is_here) {
        broker.fail("password_file", "expected ca_file, too: without TLS the password is readable on the network");
    }
    if (settings.certificate_file.empty() != settings.key_file.empty()) {
        broker.fail("certificate_file", "expected both certificate_file and key_file, or none");
    }
    settings.password = password_file.empty() ? "" : first_line_of(password_file);
    return settings;
}

}  // namespace

bool is_name_of_machine(std::string_view level) {
    constexpr std::size_t longest = 64;
    return !level.empty() && level.size() <= longest &&
           level.find_first_not_of(letters_of_levels) == std::string_view::npos && level != "all";
}

GatewaySettings read_gateway_settings(const std::string& file) {
    TomlFile toml = TomlFile::open(file);
    TomlFile::Table root = toml.root();
    GatewaySettings settings;
    settings.machine = level(root, "machine");
    settings.topic = level(root, "topic", "millforce");
    settings.telemetry_socket = root.text("telemetry_socket", "");
    settings.jobs = folder(root, "jobs");
    settings.tools = folder(root, "tools");
    settings.maps = folder(root, "maps");
    settings.broker = read_broker(root.table("broker"));
    root.reject_unknown_keys();
    return settings;
}

ShopSettings read_shop_settings(const std::string& file) {
    TomlFile toml = TomlFile::open(file);
    TomlFile::Table root = toml.root();
    ShopSettings settings;
    settings.topic = level(root, "topic", "millforce");
    settings.broker = read_broker(root.table("broker"));
    root.reject_unknown_keys();
    return settings;
}

}  // namespace millforce::host
