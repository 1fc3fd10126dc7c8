// SPDX-License-Identifier: Apache-2.0
#include "receive_control.hpp"

#include <cstdlib>
#include <cstring>

#include "socketcan/can_socket.hpp"

namespace millforce::socketcan {

namespace {

constexpr std::int64_t longest_age_us = 1'000'000;
/// A stamp further ahead of the clock that it is compared with was made with another setting of it.
constexpr std::int64_t largest_lead_us = 20'000;
/// The clock was set where the offset changed by more than this beside the measurement's own uncertainty. It changes
/// by steps alone: what disciplines a clock gradually moves both clocks.
constexpr std::int64_t clock_was_set_us = 5'000;
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

/// Between two readings another process may run: `uncertain_us`.
StampClock::Offset StampClock::measured_once() {
    const std::int64_t before_us = microseconds(now(CLOCK_MONOTONIC));
    const std::int64_t real_us = microseconds(now(CLOCK_REALTIME));
    const std::int64_t gap_us = microseconds(now(CLOCK_MONOTONIC)) - before_us;
    return {real_us - before_us - gap_us / 2, gap_us};
}

/// Of several tries the one with the shortest gap counts.
StampClock::Offset StampClock::measured() {
    Offset best{0, INT64_MAX};
    for (int k = 0; k < offset_tries && best.uncertain_us > good_gap_us; ++k) {
        const Offset measured = measured_once();
        best = measured.uncertain_us < best.uncertain_us ? measured : best;
    }
    return best;
}

std::int64_t StampClock::unix_offset_us() {
    if (!has_offset_) {
        offset_us_ = measured().offset_us;
        has_offset_ = true;
    }
    return offset_us_;
}

bool StampClock::is_far_from(const Offset& measured) {
    return std::abs(measured.offset_us - unix_offset_us()) > clock_was_set_us + measured.uncertain_us;
}

void StampClock::look() {
    if (is_far_from(measured_once())) {
        follow_setting();
    }
}

/// The old offset is better than a new one that is a few µs off.
void StampClock::follow_setting() {
    if (const Offset now = measured(); is_far_from(now)) {
        offset_us_ = now.offset_us;
    }
}

/// A stamp that does not fit means that the clock was set, or that this program was suspended for long, before it read
/// the time or after. Only a measurement shows which.
std::uint64_t StampClock::monotonic_from(const timespec& stamp, std::uint64_t now_us) {
    auto near_us = static_cast<std::int64_t>(now_us);
    std::int64_t time_us = microseconds(stamp) - unix_offset_us();
    if (time_us > near_us + largest_lead_us || time_us < near_us - longest_age_us) {
        near_us = static_cast<std::int64_t>(monotonic_us());
        look();
        time_us = microseconds(stamp) - offset_us_;
    }
    const bool is_past = time_us > 0 && time_us <= near_us + largest_lead_us;
    return static_cast<std::uint64_t>(is_past ? time_us : near_us);
}

}  // namespace millforce::socketcan
