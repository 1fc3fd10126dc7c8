// SPDX-License-Identifier: Apache-2.0
#include "recording/recording.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

TEST_GROUP(Recording){};

TEST(Recording, a_force_sensors_rows_keep_their_velocities_where_no_current_is_measured) {
    const test::TemporaryFolder folder;
    RecordedStep step;
    step.sample.present = hal::mask(hal::Present::spindle_count) | hal::mask(hal::Present::force_sensor);
    step.sample.force_N = {100.0F, -20.0F};
    step.sample.axis_velocity_mm_s = {5.0F, 0.5F, 0.0F};
    RecordingWriter writer(folder.path("r.csv"), 4096, true);
    writer.add(step);
    writer.commit();
    RecordingReader reader(folder.path("r.csv"), 4096);
    CHECK(reader.next());
    BYTES_EQUAL(step.sample.present, reader.sample().present);
    DOUBLES_EQUAL(5.0, static_cast<double>(reader.sample().axis_velocity_mm_s[0]), 0.0);
    DOUBLES_EQUAL(0.5, static_cast<double>(reader.sample().axis_velocity_mm_s[1]), 0.0);
    DOUBLES_EQUAL(-20.0, static_cast<double>(reader.sample().force_N[1]), 0.0);
}

TEST(Recording, a_row_lacks_what_its_sample_did_not_have) {
    const test::TemporaryFolder folder;
    RecordedStep step;
    step.sample.present = hal::mask(hal::Present::spindle_current) | hal::axis_mask(0);
    step.sample.spindle_current_A = 3.0F;
    RecordingWriter writer(folder.path("r.csv"), 4096, false);
    writer.add(step);
    step.sample.time_us = 1000;
    step.sample.present = hal::mask(hal::Present::spindle_count);
    writer.add(step);
    writer.commit();
    RecordingReader reader(folder.path("r.csv"), 4096);
    CHECK(reader.next());
    BYTES_EQUAL(hal::mask(hal::Present::spindle_current) | hal::axis_mask(0), reader.sample().present);
    CHECK(reader.next());
    BYTES_EQUAL(hal::mask(hal::Present::spindle_count), reader.sample().present);
}

TEST(Recording, without_an_angle_or_a_force_in_a_row_has_neither) {
    const test::TemporaryFolder folder;
    RecordingReader reader(folder.write("r.csv",
                                        "time_s,spindle_angle_rad,fx_N,fy_N,x_velocity_mm_s,y_velocity_mm_s\n"
                                        "0,1,5,6,1,0\n0.001,,5,6,1,0\n0.002,1,5,,1,0\n0.003,1,5,6,,0\n"),
                           4096);
    const int count = hal::mask(hal::Present::spindle_count);
    const int force = hal::mask(hal::Present::force_sensor);
    for (const int present : {count | force, force, count, count}) {
        CHECK(reader.next());
        BYTES_EQUAL(present, reader.sample().present);
    }
    CHECK_FALSE(reader.next());
}

TEST(Recording, refuses_a_programmed_feed_that_no_machine_has) {
    const test::TemporaryFolder folder;
    for (const char* feed : {"-1", "200000"}) {
        const auto file = folder.write("r.csv", std::string("time_s,spindle_angle_rad,spindle_current_A,x_current_A,"
                                                            "x_velocity_mm_s,programmed_feed_mm_s\n0,1,1,1,1,") +
                                                    feed + "\n");
        const std::string message = test::message_of<InputError>([&] {
            RecordingReader reader(file, 4096);
            static_cast<void>(reader.next());
        });
        STRCMP_CONTAINS("expected a feed from 0 to 1e5 mm/s", message.c_str());
    }
}
