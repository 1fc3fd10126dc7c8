// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "live/live_page.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// The web page, its stream of rows and the metrics over HTTP/1.1, for browsers and Prometheus on this computer: it
/// listens on 127.0.0.1 and ::1 alone, answers GET and HEAD, and only to requests whose Host is this computer's
/// loopback, so that no page of another site can read from it by a name that points here.
///
/// All of it runs in turns of the hub's thread, with a bounded number of connections, memory for each, and steps in a
/// turn. A connection that neither sends nor takes anything for 10 s is closed.
class WebServer final : public TelemetrySink {
  public:
    /// `port` 0: any that is free. Throws InputError: the port is used, or not allowed.
    WebServer(std::uint16_t port, const std::string& title);
    ~WebServer() override;
    WebServer(const WebServer&) = delete;
    WebServer& operator=(const WebServer&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }

    void on_begin() override;
    void on_sample(const Telemetry& telemetry) override;
    void on_event(const TelemetryEvent& event) override { messages_.add(event); }
    void on_turn() override;

  private:
    class Daemon;  ///< of one address
    friend class Daemon;

    std::uint16_t port_ = 0;
    LivePage page_;
    LiveMessages messages_{};
    unsigned streams_ = 0;
    std::uint64_t silent_turns_ = 0;
    std::vector<std::unique_ptr<Daemon>> daemons_{};
};

}  // namespace millforce::host
