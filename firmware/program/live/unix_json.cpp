// SPDX-License-Identifier: Apache-2.0
#include "live/unix_json.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <utility>

#include "files/input_error.hpp"
#include "report/json_writer.hpp"
#include "telemetry/telemetry_fields.hpp"

namespace millforce::host {

namespace {

constexpr std::uint64_t period_us = 1'000'000;

std::string in_s(std::uint64_t time_us) {
    return fmt::format("{:.6f}", 1e-6 * static_cast<double>(time_us));
}

}  // namespace

UnixJson::UnixJson(std::string path)
    : path_(std::move(path)), socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    if (path_.size() >= sizeof(sockaddr_un::sun_path)) {
        ::close(socket_);
        throw InputError(fmt::format("--gateway: {}: expected a path of at most {} characters", path_,
                                     sizeof(sockaddr_un::sun_path) - 1));
    }
}

UnixJson::~UnixJson() {
    ::close(socket_);
}

void UnixJson::send(const std::string& text) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path_.c_str(), path_.size() + 1);
    (void)::sendto(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                   reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

void UnixJson::on_sample(const Telemetry& telemetry) {
    if (telemetry.unix_us >= next_us_) {
        next_us_ = telemetry.unix_us + period_us;
        send(fmt::format("state {{\"unix_s\":{},{}", in_s(telemetry.unix_us), telemetry_json(telemetry).substr(1)));
    }
}

void UnixJson::on_event(const TelemetryEvent& event) {
    JsonWriter text;
    text.text(event.text);
    send(fmt::format(R"(event {{"unix_s":{},"level":"{}","text":{}}})", in_s(event.unix_us), name(event.level),
                     text.str()));
}

}  // namespace millforce::host
