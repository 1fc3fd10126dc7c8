// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/gateway_settings.hpp"
#include "gateway/mqtt_client.hpp"
#include "live/loopback_server.hpp"
#include "shop/shop_machines.hpp"

namespace millforce::host {

/// A page of all machines of a shop, from the messages of their gateways at a broker: `/`, and `/shop.json` with what
/// is known. It only listens. One thread.
class Shop final : private MqttListener, private WebPages {
  public:
    /// Throws InputError: certificates that cannot be read, a port that is used.
    Shop(const ShopSettings& settings, std::uint16_t port);

    [[nodiscard]] std::uint16_t port() const { return server_.port(); }
    void run(const std::atomic<bool>& stop);

  private:
    void on_connected() override;
    void on_disconnected(std::string_view reason) override;
    void on_acknowledged(int) override {}
    void on_message(std::string_view topic, std::string_view payload) override;
    [[nodiscard]] std::optional<WebResource> resource(std::string_view path) const override;
    [[nodiscard]] std::string shop_json() const;

    ShopSettings settings_;
    ShopMachines machines_{};
    std::string trouble_ = "connecting";  ///< why the broker is not there; empty: it is
    MqttClient client_;
    LoopbackServer server_;
};

}  // namespace millforce::host
