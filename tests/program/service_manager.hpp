// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace millforce::test {

/// The side of a service manager in sd_notify(3): programs that are started while this is there tell it how they are.
class ServiceManager {
  public:
    /// `name`: of the socket to make. `watchdog_us`: what the programs find in WATCHDOG_USEC; 0: no watchdog.
    explicit ServiceManager(const std::string& name, int watchdog_us = 0)
        : descriptor_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        name.copy(address.sun_path, sizeof address.sun_path - 1);
        if (::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            throw std::runtime_error("no socket " + name);
        }
        ::setenv("NOTIFY_SOCKET", name.c_str(), 1);
        if (watchdog_us > 0) {
            ::setenv("WATCHDOG_USEC", std::to_string(watchdog_us).c_str(), 1);
        }
    }
    ~ServiceManager() {
        ::unsetenv("NOTIFY_SOCKET");
        ::unsetenv("WATCHDOG_USEC");
        ::close(descriptor_);
    }
    ServiceManager(const ServiceManager&) = delete;
    ServiceManager& operator=(const ServiceManager&) = delete;

    /// The next message, whatever it is; "": none came in this time.
    [[nodiscard]] std::string receive(long patience_ms = 10'000) const {
        const timeval patience{patience_ms / 1000, 1000 * (patience_ms % 1000)};
        ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        std::array<char, 300> buffer{};
        const ssize_t length = ::recv(descriptor_, buffer.data(), buffer.size(), 0);
        return std::string(buffer.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
    }
    /// Receives until this comes; false: nothing more came before.
    [[nodiscard]] bool hears(const std::string& message) const {
        std::string heard = receive();
        while (!heard.empty() && heard != message) {
            heard = receive();
        }
        return heard == message;
    }
    /// Takes what is there; true: nothing comes then.
    [[nodiscard]] bool hears_nothing(long duration_ms) const {
        while (!receive(1).empty()) {
        }
        return receive(duration_ms).empty();
    }

  private:
    int descriptor_;
};

}  // namespace millforce::test
