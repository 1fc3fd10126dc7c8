// SPDX-License-Identifier: Apache-2.0
#include "live/web_server.hpp"

namespace millforce::host {

WebServer::WebServer(std::uint16_t port, const std::string& title) : page_(title), server_(port, page_, &messages_) {}

void WebServer::on_sample(const Telemetry& telemetry) {
    page_.take(telemetry);
    messages_.add(telemetry);
    silent_turns_ = 0;
}

void WebServer::on_turn() {
    constexpr std::uint64_t turns_of_silence = 100;  // of 20 ms each
    if (++silent_turns_ % turns_of_silence == 0) {
        messages_.add_sign_of_life();
    }
    server_.turn();
}

}  // namespace millforce::host
