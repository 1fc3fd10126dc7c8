// SPDX-License-Identifier: Apache-2.0
#include "bus/loopback_bus.hpp"
#include "can_frames.hpp"

#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using sim::LoopbackBus;

TEST_GROUP(LoopbackBus) {
    LoopbackBus bus{1e6};
    std::vector<std::uint32_t> ids{};
    std::vector<std::uint64_t> times_us{};
    int first = bus.attach([](const hal::CanFrame&, std::uint64_t) {});
    int second = bus.attach([this](const hal::CanFrame& f, std::uint64_t time_us) {
        ids.push_back(f.id);
        times_us.push_back(time_us);
    });
};

TEST(LoopbackBus, the_lowest_id_of_those_that_wait_goes_first) {
    for (const std::uint32_t id : {0x300U, 0x200U, 0x100U}) {
        bus.send(first, frame_of_length(id, 8), 0);
    }
    bus.advance_to(1000);
    CHECK_EQUAL(3U, ids.size());
    UNSIGNED_LONGS_EQUAL(0x100, ids[0]);
    UNSIGNED_LONGS_EQUAL(0x300, ids[2]);
}

TEST(LoopbackBus, frames_take_the_time_of_their_bits) {
    bus.send(first, frame_of_length(0x100, 8), 0);
    bus.send(first, frame_of_length(0x200, 0), 0);
    bus.advance_to(100);
    CHECK(times_us.empty());
    bus.advance_to(1000);
    CHECK_EQUAL(122U, times_us[0]);
    CHECK_EQUAL(122U + 52U, times_us[1]);
}

TEST(LoopbackBus, nobody_hears_itself) {
    bus.send(second, frame_of_length(0x100, 8), 0);
    bus.advance_to(1000);
    CHECK(ids.empty());
    UNSIGNED_LONGS_EQUAL(1, bus.delivered());
}

TEST(LoopbackBus, a_fault_loses_doubles_or_delays_frames) {
    bus.set_fault([](const hal::CanFrame& f) {
        return LoopbackBus::Fate{f.id == 0x100 ? 0 : 2, f.id == 0x300 ? 500ULL : 0ULL, f};
    });
    for (const std::uint32_t id : {0x100U, 0x300U, 0x200U}) {
        bus.send(first, frame_of_length(id, 1), 0);
    }
    bus.advance_to(1000);
    CHECK_EQUAL(4U, ids.size());
    UNSIGNED_LONGS_EQUAL(0x200, ids[0]);
    UNSIGNED_LONGS_EQUAL(0x300, ids[3]);
    CHECK(times_us[2] > 500);
}
