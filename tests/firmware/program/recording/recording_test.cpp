// SPDX-License-Identifier: Apache-2.0
#include "recording/recording.hpp"
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
