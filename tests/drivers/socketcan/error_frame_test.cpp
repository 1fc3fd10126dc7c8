// SPDX-License-Identifier: Apache-2.0
#include <linux/can/error.h>

#include <array>
#include <random>

#include "socketcan/can_socket.hpp"
#include "socketcan/error_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::socketcan;

namespace {

ErrorReport report_of(std::uint32_t id, std::uint8_t controller_byte) {
    const std::array<std::uint8_t, 8> data{0, controller_byte};
    return decode_error_frame(id, data);
}

}  // namespace

TEST_GROUP(ErrorFrame){};

TEST(ErrorFrame, the_worse_of_two_directions_is_the_state) {
    const ErrorReport report = report_of(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_WARNING);
    CHECK(report.has_state);
    CHECK(report.state == ControllerState::error_passive);
}

TEST(ErrorFrame, bus_off_is_worse_than_what_the_controller_byte_says) {
    CHECK(report_of(CAN_ERR_BUSOFF | CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING).state == ControllerState::bus_off);
}

TEST(ErrorFrame, a_restart_is_error_active_again) {
    const ErrorReport report = report_of(CAN_ERR_RESTARTED, 0);
    CHECK(report.restarted && report.has_state);
    CHECK(report.state == ControllerState::error_active);
}

TEST(ErrorFrame, an_overflow_is_no_change_of_state) {
    const ErrorReport report = report_of(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
    CHECK(report.receive_overflow);
    CHECK_FALSE(report.has_state);
}

TEST(ErrorFrame, any_bytes_and_any_length_decode_to_something) {
    std::mt19937 random(5);
    for (int k = 0; k < 100'000; ++k) {
        std::array<std::uint8_t, 8> data{};
        for (std::uint8_t& byte : data) {
            byte = static_cast<std::uint8_t>(random());
        }
        const std::size_t length = random() % 9;
        const ErrorReport report =
            decode_error_frame(static_cast<std::uint32_t>(random()), std::span(data).first(length));
        CHECK(report.state <= ControllerState::bus_off);
    }
}

TEST_GROUP(AbsentInterface){};

TEST(AbsentInterface, is_a_state_and_no_failure) {
    CanSocketSettings settings;
    CHECK_FALSE(settings.set_interface(""));
    CHECK_FALSE(settings.set_interface("a_name_of_16_chr"));
    CHECK(settings.set_interface("no_such_can"));
    CanSocket socket(settings);
    socket.poll(monotonic_us());
    CHECK(socket.health().state == LinkState::absent);
    CHECK(socket.health().last_error != 0);
    millforce::hal::CanFrame frame;
    std::uint64_t time_us = 0;
    CHECK_FALSE(socket.receive(frame, time_us));
    CHECK_FALSE(socket.send(frame));
    UNSIGNED_LONGS_EQUAL(1, socket.health().send_failures);
}

TEST_GROUP(LinkMessage){};

TEST(LinkMessage, any_bytes_of_any_length_are_read_within_their_bounds) {
    std::mt19937 random(17);
    for (int k = 0; k < 100'000; ++k) {
        std::array<std::uint8_t, 256> bytes{};
        for (std::uint8_t& byte : bytes) {
            byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : random() % 32);
        }
        const std::size_t length = random() % (bytes.size() + 1);
        bytes[0] = static_cast<std::uint8_t>(length);  // a header that fits: the attributes are what is tried
        bytes[1] = bytes[2] = bytes[3] = 0;
        bytes[4] = 16;  // RTM_NEWLINK
        bytes[5] = 0;
        const InterfaceReport report = read_link_message(std::span(bytes).first(length));
        CHECK(report.answered);
        CHECK(report.state <= ControllerState::bus_off);
    }
}
