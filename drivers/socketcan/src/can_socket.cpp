// SPDX-License-Identifier: Apache-2.0
#include "socketcan/can_socket.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "receive_control.hpp"

namespace millforce::socketcan {

namespace {

/// Most frames that one call drops: a flood of them must not keep it busy.
constexpr int most_skipped_per_call = 256;
/// Frames of so long a time may have the stamps of a clock that was set meanwhile.
constexpr std::uint64_t clock_look_period_us = 2'000;

template <typename Value>
bool set_option(int descriptor, int level, int name, const Value& value) {
    return setsockopt(descriptor, level, name, &value, sizeof value) == 0;
}

LinkState link_state(ControllerState state) {
    switch (state) {
        case ControllerState::error_active:
            return LinkState::error_active;
        case ControllerState::error_warning:
            return LinkState::error_warning;
        case ControllerState::error_passive:
            return LinkState::error_passive;
        case ControllerState::bus_off:
            return LinkState::bus_off;
    }
    return LinkState::error_active;
}

void copy_frame(const canfd_frame& raw, hal::CanFrame& frame) {
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.length = std::min<std::uint8_t>(raw.len, hal::largest_can_length);
    std::copy_n(raw.data, frame.data.size(), frame.data.begin());
}

}  // namespace

bool CanSocketSettings::set_interface(std::string_view name) {
    if (name.empty() || name.size() >= interface.size()) {
        return false;
    }
    interface = {};
    std::copy(name.begin(), name.end(), interface.begin());
    return true;
}

CanSocket::CanSocket(const CanSocketSettings& settings) : settings_(settings) {
    settings_.interface.back() = '\0';
}

CanSocket::~CanSocket() {
    close();
}

void CanSocket::poll(std::uint64_t now_us) {
    recent_us_ = now_us;
    if (now_us >= next_clock_look_us_) {
        next_clock_look_us_ = now_us + clock_look_period_us;
        clock_.look();
    }
    if (now_us < next_look_us_) {
        return;
    }
    next_look_us_ = now_us + settings_.look_period_us;
    if (!is_open()) {
        open();
    }
    if (is_open()) {
        look_at_interface();
    }
}

void CanSocket::open() {
    descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (descriptor_ < 0 || !configure() || !bind_to_interface()) {
        health_.last_error = errno;
        close();
        return;
    }
    kernel_drops_ = 0;
    ++health_.opened;
    health_.state = LinkState::error_active;
}

bool CanSocket::configure() const {
    const int on = 1;
    const int off = 0;
    const can_err_mask_t all_errors = CAN_ERR_MASK;
    // Not allowed, or no CAN FD: it works without.
    set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on);
    if (!set_option(descriptor_, SOL_SOCKET, SO_RCVBUFFORCE, settings_.receive_buffer_bytes)) {
        set_option(descriptor_, SOL_SOCKET, SO_RCVBUF, settings_.receive_buffer_bytes);
    }
    return set_option(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, on) &&
           set_option(descriptor_, SOL_SOCKET, SO_RXQ_OVFL, on) &&
           set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, settings_.receive_own ? on : off) &&
           set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, all_errors) && set_filters();
}

bool CanSocket::set_filters() const {
    if (settings_.filter_count == 0) {
        return true;
    }
    std::array<can_filter, filter_capacity> filters{};
    const std::size_t count = std::min(settings_.filter_count, filter_capacity);
    for (std::size_t k = 0; k < count; ++k) {
        filters[k].can_id = settings_.filters[k].id & CAN_SFF_MASK;
        filters[k].can_mask = (settings_.filters[k].mask & CAN_SFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG;
    }
    const auto bytes = static_cast<socklen_t>(count * sizeof filters[0]);
    return setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) == 0;
}

bool CanSocket::bind_to_interface() {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    interface_index_ = static_cast<int>(if_nametoindex(settings_.interface.data()));
    address.can_ifindex = interface_index_;
    if (interface_index_ == 0) {
        return false;
    }
    return ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

void CanSocket::close() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
    descriptor_ = -1;
    health_.state = LinkState::absent;
}

/// Error frames come with the next event only: a socket that was opened after one, or lost one, learns it here.
void CanSocket::look_at_interface() {
    const InterfaceReport report = query_.ask(interface_index_);
    if (!report.answered) {
        return;
    }
    if (!report.found) {
        on_failure(ENODEV);
    } else if (!report.is_up) {
        health_.state = LinkState::down;
    } else if (!report.has_carrier) {
        enter(LinkState::bus_off);
    } else if (report.has_state) {
        enter(link_state(report.state));
    } else if (health_.state == LinkState::down || health_.state == LinkState::bus_off) {
        enter(LinkState::error_active);
    }
}

void CanSocket::enter(LinkState state) {
    health_.bus_offs += state == LinkState::bus_off && health_.state != LinkState::bus_off ? 1U : 0U;
    health_.state = state;
}

void CanSocket::on_failure(int error) {
    health_.last_error = error;
    if (error == ENETDOWN) {
        health_.state = LinkState::down;
    } else if (error == ENODEV || error == ENXIO || error == EBADF) {
        close();
    }
}

bool CanSocket::receive(hal::CanFrame& frame, std::uint64_t& time_us) {
    ReceivedFrame received;
    const bool is_there = receive(received);
    frame = received.frame;
    time_us = received.time_us;
    return is_there;
}

bool CanSocket::receive(ReceivedFrame& received) {
    for (int skipped = 0; is_open() && skipped < most_skipped_per_call; ++skipped) {
        const Fetched fetched = fetch(received);
        if (fetched != Fetched::skipped) {
            return fetched == Fetched::frame;
        }
    }
    return false;
}

CanSocket::Fetched CanSocket::fetch(ReceivedFrame& received) {
    canfd_frame raw{};
    iovec place{&raw, sizeof raw};
    alignas(cmsghdr) std::array<char, 128> control{};
    msghdr message{};
    message.msg_iov = &place;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(descriptor_, &message, 0);
    if (size < 0) {
        if (errno != EAGAIN && errno != EINTR) {
            on_failure(errno);
        }
        return Fetched::nothing;
    }
    const ReceiveControl beside = receive_control(message);
    if (beside.has_drops) {
        health_.overruns += beside.drops - kernel_drops_;
        kernel_drops_ = beside.drops;
    }
    if (size == CANFD_MTU) {
        ++health_.fd_frames;
        return Fetched::skipped;
    }
    if (size != CAN_MTU || raw.len > hal::largest_can_length) {
        ++health_.malformed;
        return Fetched::skipped;
    }
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
        take_error_frame(raw.can_id, std::span(raw.data).first(raw.len));
        return Fetched::skipped;
    }
    copy_frame(raw, received.frame);
    received.time_us = beside.has_time ? clock_.monotonic_from(beside.time, recent_us_) : monotonic_us();
    recent_us_ = std::max(recent_us_, received.time_us);
    // Set by the kernel on what came from this very socket.
    received.is_own = (message.msg_flags & MSG_CONFIRM) != 0;
    ++health_.received;
    return Fetched::frame;
}

void CanSocket::take_error_frame(std::uint32_t id, std::span<const std::uint8_t> data) {
    const ErrorReport report = decode_error_frame(id, data);
    ++health_.error_frames;
    health_.controller_overflows += report.receive_overflow ? 1U : 0U;
    health_.restarts += report.restarted ? 1U : 0U;
    if (report.has_state) {
        enter(link_state(report.state));
    }
}

bool CanSocket::send(const hal::CanFrame& frame) {
    can_frame raw{};
    const bool is_valid =
        frame.length <= hal::largest_can_length && frame.id <= (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    if (!is_open() || !is_valid) {
        ++health_.send_failures;
        return false;
    }
    raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
    raw.len = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
    if (::send(descriptor_, &raw, sizeof raw, MSG_DONTWAIT | MSG_NOSIGNAL) == sizeof raw) {
        ++health_.sent;
        health_.send_queue_full = false;
        return true;
    }
    ++health_.send_failures;
    health_.send_queue_full = errno == ENOBUFS || errno == EAGAIN;
    on_failure(errno);
    return false;
}

void CanSocket::wait(std::uint64_t timeout_us) const {
    timespec timeout{};
    timeout.tv_sec = static_cast<time_t>(timeout_us / 1'000'000);
    timeout.tv_nsec = static_cast<long>(timeout_us % 1'000'000) * 1000;
    pollfd waited{descriptor_, POLLIN, 0};
    // A socket whose interface is down is always ready, with an error: it would turn the loop.
    const bool is_quiet = !is_up();
    ppoll(&waited, is_quiet ? 0 : 1, &timeout, nullptr);
}

}  // namespace millforce::socketcan
