// SPDX-License-Identifier: Apache-2.0
#include "firmware_link/link_drives.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;

TEST_GROUP(LinkDrives){};

TEST(LinkDrives, give_each_message_once_and_nothing_before_the_first) {
    firmware::LinkDrives drives;
    hal::DriveSample sample;
    drives.poll(1000);  // no message: time alone brings no sample
    CHECK(drives.state() == hal::SourceState::waiting);
    CHECK_FALSE(drives.take_sample(sample));
    local_link::SampleMessage message;
    message.time_us = 5000;
    message.present = 0x03;
    message.spindle_index_count = 77;
    message.spindle_index_number = 4;
    drives.on_message(message);
    CHECK(drives.state() == hal::SourceState::running);
    BYTES_EQUAL(0x03, drives.complete());
    CHECK(drives.take_sample(sample));
    UNSIGNED_LONGS_EQUAL(5000, sample.time_us);
    UNSIGNED_LONGS_EQUAL(77, sample.spindle_index_count);
    UNSIGNED_LONGS_EQUAL(4, sample.spindle_index_number);
    CHECK_FALSE(drives.take_sample(sample));
}
