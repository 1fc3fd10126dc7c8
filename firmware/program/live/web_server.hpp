// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "live/live_page.hpp"
#include "live/loopback_server.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// The web page of one controller, its stream of rows and its metrics (loopback_server.hpp), in turns of the hub's
/// thread.
class WebServer final : public TelemetrySink {
  public:
    /// As LoopbackServer.
    WebServer(std::uint16_t port, const std::string& title);

    [[nodiscard]] std::uint16_t port() const { return server_.port(); }

    void on_begin() override { server_.start(); }
    void on_sample(const Telemetry& telemetry) override;
    void on_event(const TelemetryEvent& event) override { messages_.add(event); }
    void on_turn() override;

  private:
    LivePage page_;
    LiveMessages messages_{};
    LoopbackServer server_;
    std::uint64_t silent_turns_ = 0;
};

}  // namespace millforce::host
