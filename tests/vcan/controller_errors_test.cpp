// SPDX-License-Identifier: Apache-2.0
#include "serial_line_can.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;
using socketcan::LinkState;

TEST_GROUP(ControllerErrors){};

TEST(ControllerErrors, warning_passive_and_bus_off_are_states_and_the_interface_set_up_again_ends_them) {
    SerialLineCan line;
    CHECK(line.is_there());
    Listener listener(on(line.name()));
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::error_active; }));
    line.say("t1232BEEF");
    CHECK(listener.run_until([&] { return listener.frames.size() == 1; }));
    UNSIGNED_LONGS_EQUAL(0xEF, listener.frames[0].data[1]);
    CHECK(listener.socket.send(frame_of(0x321, {0xAB})));
    listener.run_ms(50);
    CHECK(line.heard().find("t3211AB\r") != std::string::npos);

    line.say("sw096127");
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::error_warning; }));
    CHECK(listener.socket.is_up());
    line.say("sp130127");
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::error_passive; }));
    line.say("sb000000");
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::bus_off; }));
    CHECK_FALSE(listener.socket.is_up());
    listener.run_ms(50);
    CHECK(listener.socket.health().state == LinkState::bus_off);
    UNSIGNED_LONGS_EQUAL(1, listener.socket.health().bus_offs);
    CHECK(listener.socket.health().error_frames >= 3);

    LONGS_EQUAL(0, shell("ip link set " + line.name() + " down"));
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::down; }));
    LONGS_EQUAL(0, shell("ip link set " + line.name() + " up"));
    CHECK(listener.run_until([&] { return listener.socket.health().state == LinkState::error_active; }));
    line.say("t1231AA");
    CHECK(listener.run_until([&] { return listener.frames.size() == 2; }));
}

TEST(ControllerErrors, a_bus_that_recovers_step_by_step_is_followed) {
    SerialLineCan line;
    Listener listener(on(line.name()));
    for (const auto& [said, state] :
         {std::pair{"sp130127", LinkState::error_passive}, std::pair{"sw096000", LinkState::error_warning},
          std::pair{"sa000000", LinkState::error_active}}) {
        line.say(said);
        CHECK(listener.run_until([&, expected = state] { return listener.socket.health().state == expected; }));
    }
}

TEST(ControllerErrors, a_socket_opened_after_bus_off_sees_it_too) {
    SerialLineCan line;
    line.say("sb000000");
    sleep_ms(50);
    Listener listener(on(line.name()));
    CHECK(listener.socket.health().state == LinkState::bus_off);
}

TEST(ControllerErrors, an_adapter_that_is_unplugged_is_absent) {
    Listener listener(on("none"));
    {
        SerialLineCan line;
        Listener on_line(on(line.name()));
        CHECK(on_line.socket.is_up());
    }
    SerialLineCan again;
    Listener on_line(on(again.name()));
    CHECK(on_line.socket.is_up());
}

TEST(ControllerErrors, what_an_adapter_says_that_is_no_frame_does_no_harm) {
    SerialLineCan line;
    Listener listener(on(line.name()));
    for (const char* said : {"t", "t12", "t1239", "t123Z", "T1234567", "sx", "sw09", "sp999999", "\x07\x07", "r1230"}) {
        line.say(said);
    }
    line.say("t1231AA");
    CHECK(listener.run_until([&] {
        return !listener.frames.empty() && listener.frames.back().id == 0x123 && !listener.frames.back().remote;
    }));
}
