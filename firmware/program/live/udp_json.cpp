// SPDX-License-Identifier: Apache-2.0
#include "live/udp_json.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

namespace {

struct HostAndPort {
    std::string host;
    std::string port;
};

HostAndPort split(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    HostAndPort found;
    if (colon != std::string::npos) {
        found = {address.substr(0, colon), address.substr(colon + 1)};
    }
    if (found.host.size() > 2 && found.host.front() == '[' && found.host.back() == ']') {
        found.host = found.host.substr(1, found.host.size() - 2);
    } else if (found.host.find(':') != std::string::npos) {
        found.host.clear();  // IPv6 without brackets
    }
    const bool has_port = !found.port.empty() && found.port.find_first_not_of("0123456789") == std::string::npos &&
                          found.port.size() <= 5 && std::stoul(found.port) >= 1 && std::stoul(found.port) <= 65535;
    if (found.host.empty() || !has_port) {
        throw InputError(fmt::format("--udp-json: '{}', expected HOST:PORT, e.g. 127.0.0.1:9870", printable(address)));
    }
    return found;
}

}  // namespace

UdpJson::UdpJson(const std::string& address) {
    const auto [host, port] = split(address);
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_DGRAM;
    addrinfo* found = nullptr;
    if (const int error = getaddrinfo(host.c_str(), port.c_str(), &wanted, &found); error != 0) {
        throw InputError(fmt::format("--udp-json: '{}': {}", printable(address), gai_strerror(error)));
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, freeaddrinfo);
    socket_ = ::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0 || ::connect(socket_, found->ai_addr, found->ai_addrlen) != 0) {
        const std::string reason = std::strerror(errno);
        ::close(socket_);
        throw InputError(fmt::format("--udp-json: '{}': {}", printable(address), reason));
    }
}

UdpJson::~UdpJson() {
    ::close(socket_);
}

/// That nobody listens is no error: a plotter may come later.
void UdpJson::on_sample(const Telemetry& telemetry) {
    const std::string text = fmt::format(R"({{"timestamp":{:.6f},"millforce":{}}})",
                                         1e-6 * static_cast<double>(telemetry.unix_us), telemetry_json(telemetry));
    (void)::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace millforce::host
