// SPDX-License-Identifier: Apache-2.0
#include "gateway/mqtt_client.hpp"

#include <fmt/format.h>
#include <mosquitto.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "files/input_error.hpp"

namespace millforce::host {

namespace {

constexpr int keep_alive_s = 20;
constexpr std::uint64_t shortest_pause_ms = 1'000;
constexpr std::uint64_t longest_pause_ms = 30'000;

std::uint64_t now_ms() {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(time).count());
}

const char* or_null(const std::string& text) {
    return text.empty() ? nullptr : text.c_str();
}

std::string reason_of(int code) {
    return code == MOSQ_ERR_ERRNO ? std::strerror(errno) : mosquitto_strerror(code);
}

void require(int code, const std::string& what) {
    if (code != MOSQ_ERR_SUCCESS) {
        throw InputError(fmt::format("{}: {}", what, reason_of(code)));
    }
}

}  // namespace

MqttClient::MqttClient(const BrokerSettings& settings, const std::string& id, const std::string& will,
                       MqttListener& listener)
    : settings_(settings), listener_(listener), client_(nullptr) {
    mosquitto_lib_init();
    client_ = mosquitto_new(or_null(id), id.empty(), this);
    if (client_ == nullptr) {
        throw InputError("broker: no memory for a connection");
    }
    mosquitto_connect_callback_set(client_, on_connect);
    mosquitto_disconnect_callback_set(client_, on_disconnect);
    mosquitto_publish_callback_set(client_, on_publish);
    mosquitto_message_callback_set(client_, on_message);
    if (!will.empty()) {
        require(mosquitto_will_set(client_, will.c_str(), 1, "0", 1, true), "broker");
    }
    if (!settings.username.empty()) {
        require(mosquitto_username_pw_set(client_, settings.username.c_str(), or_null(settings.password)), "broker");
    }
    if (!settings.ca_file.empty()) {
        require(mosquitto_tls_set(client_, settings.ca_file.c_str(), nullptr, or_null(settings.certificate_file),
                                  or_null(settings.key_file), nullptr),
                fmt::format("broker.ca_file: {}", settings.ca_file));
    }
}

MqttClient::~MqttClient() {
    mosquitto_destroy(client_);
    mosquitto_lib_cleanup();
}

void MqttClient::connect() {
    const int code = was_tried_ ? mosquitto_reconnect(client_)
                                : mosquitto_connect(client_, settings_.host.c_str(), settings_.port, keep_alive_s);
    was_tried_ = true;
    is_open_ = code == MOSQ_ERR_SUCCESS;
    if (!is_open_) {
        lose(reason_of(code));
    }
}

/// Whatever the reason, the next try is a little later each time.
void MqttClient::lose(std::string_view reason) {
    is_open_ = false;
    is_connected_ = false;
    pause_ms_ = std::clamp(2 * pause_ms_, shortest_pause_ms, longest_pause_ms);
    next_try_ms_ = now_ms() + pause_ms_;
    listener_.on_disconnected(reason);
}

void MqttClient::turn(int timeout_ms) {
    if (!is_open_ && now_ms() >= next_try_ms_) {
        connect();
    }
    if (!is_open_) {
        std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
        return;
    }
    if (const int code = mosquitto_loop(client_, timeout_ms, 1); code != MOSQ_ERR_SUCCESS && is_open_) {
        lose(reason_of(code));
    }
}

void MqttClient::subscribe(const std::string& topic) {
    mosquitto_subscribe(client_, nullptr, topic.c_str(), 1);
}

void MqttClient::publish(const std::string& topic, std::string_view payload, bool is_retained) {
    mosquitto_publish(client_, nullptr, topic.c_str(), static_cast<int>(payload.size()), payload.data(), 0,
                      is_retained);
}

std::optional<int> MqttClient::publish_acknowledged(const std::string& topic, std::string_view payload,
                                                    bool is_retained) {
    int number = 0;
    const int code = mosquitto_publish(client_, &number, topic.c_str(), static_cast<int>(payload.size()),
                                       payload.data(), 1, is_retained);
    return code == MOSQ_ERR_SUCCESS ? std::optional(number) : std::nullopt;
}

void MqttClient::disconnect() {
    is_open_ = false;  // a connection that is ended is not lost
    mosquitto_disconnect(client_);
    mosquitto_loop(client_, 0, 1);
}

void MqttClient::on_connect(mosquitto*, void* self, int code) {
    auto& client = *static_cast<MqttClient*>(self);
    if (code != 0) {
        client.lose(mosquitto_connack_string(code));
        return;
    }
    client.is_connected_ = true;
    client.pause_ms_ = 0;
    client.listener_.on_connected();
}

void MqttClient::on_disconnect(mosquitto*, void* self, int code) {
    auto& client = *static_cast<MqttClient*>(self);
    if (client.is_open_) {
        client.lose(reason_of(code));
    }
}

void MqttClient::on_publish(mosquitto*, void* self, int number) {
    static_cast<MqttClient*>(self)->listener_.on_acknowledged(number);
}

void MqttClient::on_message(mosquitto*, void* self, const mosquitto_message* message) {
    const std::string_view payload(static_cast<const char*>(message->payload),
                                   static_cast<std::size_t>(std::max(message->payloadlen, 0)));
    static_cast<MqttClient*>(self)->listener_.on_message(message->topic, payload);
}

}  // namespace millforce::host
