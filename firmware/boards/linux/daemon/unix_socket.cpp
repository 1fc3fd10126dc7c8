// SPDX-License-Identifier: Apache-2.0
#include "daemon/unix_socket.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "daemon/service.hpp"
#include "daemon/unix_address.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

int new_socket() {
    return socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
}

bool is_served(const sockaddr_un& address) {
    const int probe = new_socket();
    const bool answers = connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(probe);
    return answers;
}

}  // namespace

UnixServer::UnixServer(std::string path, TurnListener* listener)
    : path_(std::move(path)), turns_(listener), stop_(stop_on_signal()) {
    const sockaddr_un address = unix_address(path_);
    struct stat status {};
    if (lstat(path_.c_str(), &status) == 0) {
        if (!S_ISSOCK(status.st_mode)) {
            throw InputError(fmt::format("{}: is there and no socket", path_));
        }
        if (is_served(address)) {
            throw InputError(fmt::format("{}: another program serves this socket", path_));
        }
        unlink(path_.c_str());
    }
    listener_ = new_socket();
    const mode_t usual = umask(0007);
    const bool is_bound = bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    const int error = errno;
    umask(usual);
    if (!is_bound || listen(listener_, 4) != 0) {
        close(listener_);
        throw InputError(fmt::format("{}: {}", path_, std::strerror(is_bound ? errno : error)));
    }
}

UnixServer::~UnixServer() {
    drop_peer();
    close(listener_);
    unlink(path_.c_str());
}

void UnixServer::drop_peer() {
    if (peer_ >= 0) {
        close(peer_);
    }
    peer_ = -1;
}

/// In steps: a signal between the check and the wait is seen with the next. What is done after poll() is known to be
/// after a pause, if there was one in it.
bool UnixServer::wait_readable(int descriptor) const {
    constexpr int step_ms = 100;
    pollfd waited[2] = {{descriptor, POLLIN, 0}, {listener_, POLLIN, 0}};
    while (!stop_asked()) {
        const int ready = poll(waited, descriptor == listener_ ? 1 : 2, step_ms);
        if (turns_ != nullptr) {
            turns_->on_turn();
        }
        if (ready > 0 && waited[0].revents != 0) {
            return true;
        }
        if (ready > 0) {
            turn_away_others();
        }
    }
    return false;
}

void UnixServer::turn_away_others() const {
    if (const int other = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); other >= 0) {
        close(other);
    }
}

bool UnixServer::wait_for_peer() {
    while (peer_ < 0 && wait_readable(listener_)) {
        peer_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    }
    return peer_ >= 0;
}

std::span<const std::uint8_t> UnixServer::receive() {
    if (peer_ < 0 || !wait_readable(peer_)) {
        return {};
    }
    const ssize_t length = recv(peer_, bytes_.data(), bytes_.size(), 0);
    if (length <= 0) {
        drop_peer();
        return {};
    }
    return std::span<const std::uint8_t>(bytes_).first(static_cast<std::size_t>(length));
}

void UnixServer::send(std::span<const std::uint8_t> bytes) {
    if (peer_ >= 0 && ::send(peer_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0) {
        drop_peer();
    }
}

}  // namespace millforce::host
