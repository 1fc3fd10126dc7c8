// SPDX-License-Identifier: Apache-2.0
#include "receive_control.hpp"

#include <cstdlib>
#include <cstring>

#include "socketcan/can_socket.hpp"

namespace millforce::socketcan {

namespace {

constexpr std::int64_t longest_age_us = 1'000'000;
/// The clock was set where the offset changed by more; no measurement is that wrong.
constexpr std::int64_t clock_was_set_us = 500'000;
constexpr int offset_tries = 100;
constexpr std::int64_t good_gap_us = 10;

std::int64_t microseconds(const timespec& time) {
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000 + time.tv_nsec / 1000;
}

timespec now(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return time;
}

}  // namespace

std::uint64_t monotonic_us() {
    return static_cast<std::uint64_t>(microseconds(now(CLOCK_MONOTONIC)));
}

ReceiveControl receive_control(msghdr& message) {
    ReceiveControl control;
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
        if (part->cmsg_level != SOL_SOCKET) {
            continue;
        }
        if (part->cmsg_type == SO_TIMESTAMPNS && part->cmsg_len >= CMSG_LEN(sizeof control.time)) {
            std::memcpy(&control.time, CMSG_DATA(part), sizeof control.time);
            control.has_time = true;
        } else if (part->cmsg_type == SO_RXQ_OVFL && part->cmsg_len >= CMSG_LEN(sizeof control.drops)) {
            std::memcpy(&control.drops, CMSG_DATA(part), sizeof control.drops);
            control.has_drops = true;
        }
    }
    return control;
}

/// Between two readings another process may run: of several tries the one with the shortest gap counts.
void StampClock::measure() {
    std::int64_t shortest_us = INT64_MAX;
    for (int k = 0; k < offset_tries && shortest_us > good_gap_us; ++k) {
        const std::int64_t before_us = microseconds(now(CLOCK_MONOTONIC));
        const std::int64_t real_us = microseconds(now(CLOCK_REALTIME));
        const std::int64_t gap_us = microseconds(now(CLOCK_MONOTONIC)) - before_us;
        if (gap_us < shortest_us) {
            shortest_us = gap_us;
            offset_us_ = real_us - before_us - gap_us / 2;
        }
    }
    has_offset_ = true;
}

std::int64_t StampClock::unix_offset_us() {
    if (!has_offset_) {
        measure();
    }
    return offset_us_;
}

/// A stamp that does not fit means that the clock was set, or that this program was suspended for long, before it read
/// the time or after. Only a measurement shows which; and the old offset is better than a new one that is a few µs off.
std::uint64_t StampClock::monotonic_from(const timespec& stamp, std::uint64_t now_us) {
    auto near_us = static_cast<std::int64_t>(now_us);
    const auto is_plausible = [&](std::int64_t time_us) {
        return time_us > 0 && time_us <= near_us + longest_age_us && time_us >= near_us - longest_age_us;
    };
    std::int64_t time_us = microseconds(stamp) - unix_offset_us();
    if (!is_plausible(time_us)) {
        near_us = static_cast<std::int64_t>(monotonic_us());
        const std::int64_t kept_us = offset_us_;
        measure();
        offset_us_ = std::abs(offset_us_ - kept_us) < clock_was_set_us ? kept_us : offset_us_;
        time_us = microseconds(stamp) - offset_us_;
    }
    const bool is_past = time_us > 0 && time_us <= near_us + longest_age_us;
    return static_cast<std::uint64_t>(is_past ? time_us : near_us);
}

}  // namespace millforce::socketcan
