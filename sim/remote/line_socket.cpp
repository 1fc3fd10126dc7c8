// SPDX-License-Identifier: Apache-2.0
#include "remote/line_socket.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

#include "daemon/unix_address.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

using Clock = std::chrono::steady_clock;

Clock::time_point after(LineSocket::Patience patience) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
}

/// Nobody listens yet, or no more: a socket that a dead process left.
bool may_come(int error) {
    return error == ENOENT || error == ECONNREFUSED || error == EAGAIN;
}

[[noreturn]] void fail(const std::string& what) {
    throw host::InputError(what);
}

}  // namespace

LineSocket::LineSocket(const std::string& path, Patience patience) : patience_(patience) {
    const auto end = after(patience_);
    while (!connect_once(path)) {
        const int error = errno;
        if (!may_come(error) || Clock::now() > end) {
            fail(fmt::format("socket:{}: no controller listens there within {:g} s: {}", path, patience_.count(),
                             std::strerror(error)));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

LineSocket::~LineSocket() {
    close(socket_);
}

/// Without O_NONBLOCK connect() itself would wait, for a listener that accepts no one.
bool LineSocket::connect_once(const std::string& path) {
    const sockaddr_un address = host::unix_address(path);
    const int fresh = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (connect(fresh, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        socket_ = fresh;
        return true;
    }
    const int error = errno;
    close(fresh);
    errno = error;
    return false;
}

void LineSocket::send(std::string_view line) {
    line_.assign(line).push_back('\n');
    const ssize_t sent = ::send(socket_, line_.data(), line_.size(), MSG_NOSIGNAL);
    if (sent != static_cast<ssize_t>(line_.size())) {
        fail(sent < 0 && errno != EAGAIN ? "the controller has closed the connection"
                                         : "the controller does not read what it is sent");
    }
}

std::string_view LineSocket::receive(std::string_view awaited) {
    const auto end = after(patience_);
    std::size_t length = 0;
    while ((length = received_.find('\n')) == std::string::npos) {
        if (received_.size() > longest_line) {
            fail(fmt::format("{} is longer than {} bytes", awaited, longest_line));
        }
        wait_for_bytes(end, awaited);
        take_bytes(awaited);
    }
    line_.assign(received_, 0, length);
    received_.erase(0, length + 1);
    return line_;
}

void LineSocket::wait_for_bytes(Clock::time_point end, std::string_view awaited) const {
    pollfd waited{socket_, POLLIN, 0};
    const auto left_ms = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left_ms <= 0 || poll(&waited, 1, static_cast<int>(left_ms)) == 0) {
        fail(fmt::format("{} did not come within {:g} s", awaited, patience_.count()));
    }
}

void LineSocket::take_bytes(std::string_view awaited) {
    std::array<char, 4096> bytes{};
    const ssize_t length = recv(socket_, bytes.data(), bytes.size(), 0);
    if (length == 0 || (length < 0 && errno != EAGAIN && errno != EINTR)) {
        fail(fmt::format("the controller closed the connection before {}", awaited));
    }
    if (length > 0) {
        received_.append(bytes.data(), static_cast<std::size_t>(length));
    }
}

bool LineSocket::has_more() const {
    char byte = 0;
    return !received_.empty() || recv(socket_, &byte, 1, MSG_PEEK) > 0;
}

}  // namespace millforce::sim
