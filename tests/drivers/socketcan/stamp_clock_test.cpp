// SPDX-License-Identifier: Apache-2.0
#include "socketcan/stamp_clock.hpp"

#include "socketcan/can_socket.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::socketcan;

namespace {

/// The kernel's stamp of so many µs after now.
timespec stamp_after(std::int64_t ahead_us) {
    timespec stamp{};
    clock_gettime(CLOCK_REALTIME, &stamp);
    const std::int64_t us = static_cast<std::int64_t>(stamp.tv_sec) * 1'000'000 + stamp.tv_nsec / 1000 + ahead_us;
    stamp.tv_sec = us / 1'000'000;
    stamp.tv_nsec = us % 1'000'000 * 1000;
    return stamp;
}

std::uint64_t exactly(const timespec& stamp, StampClock& clock) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(stamp.tv_sec) * 1'000'000 + stamp.tv_nsec / 1000 -
                                      clock.unix_offset_us());
}

}  // namespace

TEST_GROUP(StampClock) {
    StampClock clock;
};

TEST(StampClock, a_stamp_is_the_same_time_whenever_it_is_read) {
    const timespec stamp = stamp_after(0);
    const std::uint64_t now_us = monotonic_us();
    UNSIGNED_LONGS_EQUAL(exactly(stamp, clock), clock.monotonic_from(stamp, now_us));
    UNSIGNED_LONGS_EQUAL(exactly(stamp, clock), clock.monotonic_from(stamp, now_us + 900'000));
}

TEST(StampClock, a_frame_that_waited_while_the_program_paused_keeps_its_time) {
    const timespec stamp = stamp_after(-3'000'000);
    UNSIGNED_LONGS_EQUAL(exactly(stamp, clock), clock.monotonic_from(stamp, monotonic_us()));
}

TEST(StampClock, a_frame_that_came_while_the_program_paused_after_it_had_read_the_time_keeps_its_time) {
    const std::uint64_t read_us = monotonic_us() - 3'000'000;
    const timespec stamp = stamp_after(0);
    UNSIGNED_LONGS_EQUAL(exactly(stamp, clock), clock.monotonic_from(stamp, read_us));
}

TEST(StampClock, a_stamp_ahead_of_every_clock_is_now) {
    const std::uint64_t before_us = monotonic_us();
    const std::uint64_t time_us = clock.monotonic_from(stamp_after(30'000'000), before_us - 3'000'000);
    CHECK(time_us >= before_us);
    CHECK(time_us <= monotonic_us());
}
