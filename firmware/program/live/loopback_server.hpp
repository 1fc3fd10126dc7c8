// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "live/live_page.hpp"

namespace millforce::host {

/// Pages over HTTP/1.1 for browsers and Prometheus on this computer: it listens on 127.0.0.1 and ::1 alone, answers GET
/// and HEAD, and only to requests whose Host is this computer's loopback, so that no page of another site can read from
/// it by a name that points here.
///
/// Everything is done in turns of the caller's thread, with a bounded number of connections, memory for each, and steps
/// in a turn. A connection that neither sends nor takes anything for 10 s is closed.
class LoopbackServer {
  public:
    /// `port` 0: any that is free. `stream`: what `/events` sends, or null. Both outlive this. Throws InputError: the
    /// port is used, or not allowed.
    LoopbackServer(std::uint16_t port, const WebPages& pages, const LiveMessages* stream);
    ~LoopbackServer();
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;

    [[nodiscard]] std::uint16_t port() const { return port_; }

    /// In the thread of the turns, before the first.
    void start();
    void turn();

  private:
    class Daemon;  ///< of one address
    friend class Daemon;

    const WebPages& pages_;
    const LiveMessages* stream_;
    std::uint16_t port_ = 0;
    unsigned streams_ = 0;
    std::vector<std::unique_ptr<Daemon>> daemons_{};
};

}  // namespace millforce::host
