// SPDX-License-Identifier: Apache-2.0
#include "bus_peers.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;
using socketcan::LinkState;

TEST_GROUP(CanSocket){void teardown() override{shell("tc qdisc del dev vcan0 root");
shell("ip link add dev vcan0 type vcan");
shell("ip link set vcan0 mtu 72");
shell("ip link set vcan0 up");
}
}
;

TEST(CanSocket, receives_what_cansend_sends_with_the_time_of_the_kernel) {
    Listener listener(on("vcan0"));
    const std::uint64_t before_us = socketcan::monotonic_us();
    LONGS_EQUAL(0, shell("cansend vcan0 123#1122334455667788"));
    const std::uint64_t after_us = socketcan::monotonic_us();
    sleep_ms(20);
    CHECK(listener.run_until([&] { return listener.frames.size() == 1; }));
    UNSIGNED_LONGS_EQUAL(0x123, listener.frames[0].id);
    UNSIGNED_LONGS_EQUAL(8, listener.frames[0].length);
    UNSIGNED_LONGS_EQUAL(0x88, listener.frames[0].data[7]);
    CHECK(listener.times_us[0] + 1000 >= before_us);
    CHECK(listener.times_us[0] <= after_us + 1000);
}

TEST(CanSocket, sends_what_candump_shows) {
    const Candump candump("vcan0");
    Listener listener(on("vcan0"));
    CHECK(listener.socket.send(frame_of(0x2A0, {0xDE, 0xAD})));
    hal::CanFrame extended = frame_of(0x1ABCDEF0, {});
    extended.extended = true;
    CHECK(listener.socket.send(extended));
    CHECK(candump.has("1ABCDEF0#"));
    const auto frames = candump.frames();
    UNSIGNED_LONGS_EQUAL(2, frames.size());
    STRCMP_EQUAL("2A0#DEAD", frames[0].c_str());
    STRCMP_EQUAL("1ABCDEF0#", frames[1].c_str());
}

TEST(CanSocket, never_receives_its_own_frames_and_does_those_of_others) {
    Listener first(on("vcan0"));
    Listener second(on("vcan0"));
    CHECK(first.socket.send(frame_of(0x10, {1})));
    CHECK(second.socket.send(frame_of(0x20, {2})));
    first.run_ms(50);
    second.run_ms(50);
    UNSIGNED_LONGS_EQUAL(1, first.frames.size());
    UNSIGNED_LONGS_EQUAL(0x20, first.frames[0].id);
    UNSIGNED_LONGS_EQUAL(1, second.frames.size());
    UNSIGNED_LONGS_EQUAL(0x10, second.frames[0].id);
}

TEST(CanSocket, the_kernel_filters_by_id_and_keeps_29_bit_ids_and_remote_frames_out) {
    auto settings = on("vcan0");
    settings.filters[0] = {0x181, 0x7FF};
    settings.filters[1] = {0x700, 0x780};
    settings.filter_count = 2;
    Listener listener(settings);
    for (const char* sent : {"181#01", "182#01", "00000181#01", "181#R", "705#05", "785#05", "181#02"}) {
        LONGS_EQUAL(0, shell(std::string("cansend vcan0 ") + sent));
    }
    listener.run_ms(50);
    UNSIGNED_LONGS_EQUAL(3, listener.frames.size());
    UNSIGNED_LONGS_EQUAL(0x705, listener.frames[1].id);
    UNSIGNED_LONGS_EQUAL(3, listener.socket.health().received);
}

TEST(CanSocket, counts_can_fd_frames_and_goes_on) {
    Listener listener(on("vcan0"));
    LONGS_EQUAL(0, shell("cansend vcan0 123##1112233445566778899AABBCC"));
    LONGS_EQUAL(0, shell("cansend vcan0 123#11"));
    CHECK(listener.run_until([&] { return listener.frames.size() == 1; }));
    UNSIGNED_LONGS_EQUAL(1, listener.socket.health().fd_frames);
}

TEST(CanSocket, an_interface_that_goes_down_is_a_state_and_comes_back_by_itself) {
    Listener listener(on("vcan0"));
    LONGS_EQUAL(0, shell("ip link set vcan0 down"));
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::down; }));
    CHECK_FALSE(listener.socket.send(frame_of(0x10, {1})));
    UNSIGNED_LONGS_EQUAL(1, listener.socket.health().send_failures);
    LONGS_EQUAL(0, shell("ip link set vcan0 up"));
    CHECK(listener.run_until([&] { return listener.socket.is_up(); }));
    LONGS_EQUAL(0, shell("cansend vcan0 321#01"));
    CHECK(listener.run_until([&] { return listener.frames.size() == 1; }));
    CHECK(listener.socket.send(frame_of(0x10, {1})));
}

TEST(CanSocket, an_interface_that_is_removed_and_plugged_in_again_is_opened_anew) {
    Listener listener(on("vcan0"));
    LONGS_EQUAL(0, shell("ip link del vcan0"));
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::absent; }));
    CHECK_FALSE(listener.socket.send(frame_of(0x10, {1})));
    listener.run_ms(50);
    LONGS_EQUAL(0, shell("ip link add dev vcan0 type vcan"));
    LONGS_EQUAL(0, shell("ip link set vcan0 up"));
    CHECK(listener.run_until([&] { return listener.socket.is_up(); }));
    UNSIGNED_LONGS_EQUAL(2, listener.socket.health().opened);
    LONGS_EQUAL(0, shell("cansend vcan0 321#01"));
    CHECK(listener.run_until([&] { return listener.frames.size() == 1; }));
}

TEST(CanSocket, an_interface_that_is_not_there_yet_is_waited_for) {
    Listener listener(on("can_later"));
    listener.run_ms(30);
    CHECK(listener.socket.health().state == LinkState::absent);
    CHECK(listener.socket.health().last_error != 0);
    LONGS_EQUAL(0, shell("ip link add dev can_later type vcan"));
    LONGS_EQUAL(0, shell("ip link set can_later up"));
    CHECK(listener.run_until([&] { return listener.socket.is_up(); }));
    LONGS_EQUAL(0, shell("ip link del can_later"));
}

TEST(CanSocket, a_full_send_queue_is_a_state_that_ends_when_the_bus_takes_frames_again) {
    Listener listener(on("vcan0"));
    LONGS_EQUAL(0, shell("tc qdisc add dev vcan0 root tbf rate 16kbit burst 100 limit 300"));
    int sent = 0;
    while (sent < 1000 && listener.socket.send(frame_of(0x10, {1, 2, 3, 4, 5, 6, 7, 8}))) {
        ++sent;
    }
    CHECK(sent > 0 && sent < 100);
    CHECK(listener.socket.health().send_queue_full);
    LONGS_EQUAL(ENOBUFS, listener.socket.health().last_error);
    CHECK(listener.socket.is_up());
    CHECK(listener.run_until([&] { return listener.socket.send(frame_of(0x10, {1})); }));
    CHECK_FALSE(listener.socket.health().send_queue_full);
}

TEST(CanSocket, frames_that_nobody_fetched_in_time_are_counted_to_the_last) {
    auto settings = on("vcan0");
    settings.receive_buffer_bytes = 8192;
    Listener listener(settings);
    LONGS_EQUAL(0, shell("cangen vcan0 -g 0 -n 500 -I 100 -L 8"));
    listener.run_ms(20);
    LONGS_EQUAL(0, shell("cansend vcan0 101#01"));  // carries the number of those lost before it
    CHECK(listener.run_until([&] { return !listener.frames.empty() && listener.frames.back().id == 0x101; }));
    CHECK(listener.socket.health().overruns > 100);
    UNSIGNED_LONGS_EQUAL(501, listener.socket.health().received + listener.socket.health().overruns);
}
