// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/gateway_settings.hpp"

struct mosquitto;
struct mosquitto_message;

namespace millforce::host {

/// Called from MqttClient::turn().
class MqttListener {
  public:
    virtual void on_connected() = 0;
    virtual void on_disconnected(std::string_view reason) = 0;
    /// The broker has a message of publish() with acknowledgement.
    virtual void on_acknowledged(int number) = 0;
    virtual void on_message(std::string_view topic, std::string_view payload) = 0;

  protected:
    ~MqttListener() = default;
};

/// A connection to a broker by MQTT 3.1.1, by libmosquitto; made again after it was lost, with growing pauses of up to
/// 30 s. One thread.
class MqttClient {
  public:
    /// `id`: the broker keeps this client's session by it; empty: none is kept. `will`: the topic that the broker sets
    /// to "0" where this client is gone; empty: none. The listener outlives this. Throws InputError: certificates that
    /// cannot be read.
    MqttClient(const BrokerSettings& settings, const std::string& id, const std::string& will, MqttListener& listener);
    ~MqttClient();
    MqttClient(const MqttClient&) = delete;
    MqttClient& operator=(const MqttClient&) = delete;

    /// Sends, receives and connects; waits for `timeout_ms` at most, but for the connecting.
    void turn(int timeout_ms);
    [[nodiscard]] bool is_connected() const { return is_connected_; }
    void subscribe(const std::string& topic);
    void publish(const std::string& topic, std::string_view payload, bool is_retained);
    /// At least once. The number that on_acknowledged() will tell; none: it was not taken.
    [[nodiscard]] std::optional<int> publish_acknowledged(const std::string& topic, std::string_view payload,
                                                          bool is_retained);
    /// Says that this client goes, without its will.
    void disconnect();

  private:
    static void on_connect(mosquitto*, void* self, int code);
    static void on_disconnect(mosquitto*, void* self, int code);
    static void on_publish(mosquitto*, void* self, int number);
    static void on_message(mosquitto*, void* self, const mosquitto_message* message);
    void connect();
    void lose(std::string_view reason);

    BrokerSettings settings_;
    MqttListener& listener_;
    mosquitto* client_;
    bool was_tried_ = false;
    bool is_open_ = false;
    bool is_connected_ = false;
    std::uint64_t next_try_ms_ = 0;
    std::uint64_t pause_ms_ = 0;
};

}  // namespace millforce::host
