// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "gateway/gateway_settings.hpp"
#include "gateway/mqtt_client.hpp"
#include "gateway/received_files.hpp"

namespace millforce::host {

/// Between a machine's controller and a broker: state and events go out as they come, each job's report stays in its
/// folder until the broker has acknowledged it, tool files and part maps come in. A process of its own: the controller
/// has no connection beyond this computer. One thread.
class Gateway final : private MqttListener {
  public:
    /// Throws InputError: a telemetry socket that is in use, certificates that cannot be read.
    explicit Gateway(const GatewaySettings& settings);
    ~Gateway();
    Gateway(const Gateway&) = delete;
    Gateway& operator=(const Gateway&) = delete;

    void run(const std::atomic<bool>& stop);

  private:
    void on_connected() override;
    void on_disconnected(std::string_view reason) override;
    void on_acknowledged(int number) override;
    void on_message(std::string_view topic, std::string_view payload) override;

    void listen_for_telemetry();
    void pass_telemetry_on();
    void send_next_job();
    [[nodiscard]] std::filesystem::path oldest_job() const;
    void receive_file(ReceivedFiles& files, const std::string& kind, const std::string& name, std::string_view content,
                      bool is_own);
    [[nodiscard]] std::string topic(std::string_view end) const;

    GatewaySettings settings_;
    std::optional<ReceivedFiles> tools_{};
    std::optional<ReceivedFiles> maps_{};
    int telemetry_ = -1;
    MqttClient client_;
    struct JobOnItsWay {
        std::filesystem::path file;
        int number = 0;
    };
    std::optional<JobOnItsWay> job_{};
    bool was_loss_said_ = false;
};

}  // namespace millforce::host
