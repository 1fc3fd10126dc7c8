// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>

#include "local_link/messages.hpp"

namespace millforce::test {

/// A CNC's bridge: connects when the socket is there.
class Bridge {
  public:
    explicit Bridge(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            if (std::chrono::steady_clock::now() > patience) {
                throw std::runtime_error("no socket " + path);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    ~Bridge() { ::close(socket_); }
    Bridge(const Bridge&) = delete;
    Bridge& operator=(const Bridge&) = delete;

    void send(std::span<const std::uint8_t> bytes) { ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
    /// Bytes of the answer; 0: the connection was closed.
    std::size_t receive(local_link::OverrideBytes& answer) {
        const ssize_t length = ::recv(socket_, answer.data(), answer.size(), 0);
        return length > 0 ? static_cast<std::size_t>(length) : 0;
    }
    local_link::OverrideMessage ask(std::uint32_t tool, float velocity_mm_s) {
        sample.axis_velocity_mm_s[0] = velocity_mm_s;
        sample.tool = tool;
        return ask();
    }
    /// The answer to the sample, `elapsed_us` after the last one.
    local_link::OverrideMessage ask(std::uint32_t elapsed_us = 1000) {
        send_next(elapsed_us);
        return take();
    }
    void send_next(std::uint32_t elapsed_us = 1000) {
        ++sample.sequence;
        sample.time_us += elapsed_us;
        sample.spindle_count += counts_per_ms * elapsed_us / 1000;
        send(encode(sample));
    }
    local_link::OverrideMessage take() {
        local_link::OverrideBytes bytes{};
        local_link::OverrideMessage answer;
        receive(bytes);
        if (decode(bytes, answer) != local_link::MessageError::none) {
            throw std::runtime_error("no answer");
        }
        return answer;
    }

    /// A spindle at 4000 rpm, with idle current; an operator's override of 0.75.
    local_link::SampleMessage sample{.present = 0x1F, .programmed_feed_mm_s = 20.0F, .operator_limit = 0.75F};
    std::uint32_t counts_per_ms = 546;

  private:
    int socket_;
};

}  // namespace millforce::test
