// SPDX-License-Identifier: Apache-2.0
#include "run_log/local_line.hpp"

#include <bit>
#include <cstdint>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

hal::DriveSample read(const std::string& line) {
    hal::DriveSample sample;
    CHECK(read_local_line(line, sample));
    return sample;
}

bool is_refused(const std::string& line) {
    hal::DriveSample sample;
    return !read_local_line(line, sample);
}

}  // namespace

TEST_GROUP(LocalLine){};

TEST(LocalLine, gives_back_every_bit_of_what_is_known_and_nothing_else) {
    hal::DriveSample sample;
    sample.spindle_current_A = 1.0F / 3.0F;
    sample.spindle_count = 4'294'967'295U;
    sample.axis_current_A = {-1.17549449e-38F, 0.0F, 16'777'217.0F};
    sample.axis_velocity_mm_s = {0.0F, -0.1F, 3.4e38F};
    sample.present = hal::mask(hal::Present::spindle_current) | hal::mask(hal::Present::spindle_count);
    hal::set_known(sample, 0, true, false);
    hal::set_known(sample, 1, false, true);
    hal::set_known(sample, 2, true, true);
    const std::string line = local_line(sample, 1'700'000'000'000'123);
    CHECK(line.starts_with("#local (1700000000.000123) spindle_current_A=0.33333334 spindle_count=4294967295 "));
    CHECK(line.ends_with("\n"));
    CHECK(line.find("y_current_A") == std::string::npos);
    const hal::DriveSample again = read(line.substr(0, line.size() - 1));
    UNSIGNED_LONGS_EQUAL(sample.present, again.present);
    UNSIGNED_LONGS_EQUAL(sample.part, again.part);
    UNSIGNED_LONGS_EQUAL(sample.spindle_count, again.spindle_count);
    CHECK(same_bits(sample.spindle_current_A, again.spindle_current_A));
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        CHECK(same_bits(sample.axis_current_A[axis], again.axis_current_A[axis]));
        CHECK(same_bits(sample.axis_velocity_mm_s[axis], again.axis_velocity_mm_s[axis]));
    }
}

TEST(LocalLine, tells_where_the_index_was_once_there_was_one) {
    hal::DriveSample sample;
    sample.present = hal::mask(hal::Present::spindle_count);
    sample.spindle_index_count = 4'000'000'000U;
    CHECK(local_line(sample, 0).find("index") == std::string::npos);
    sample.spindle_index_number = 255;
    const std::string line = local_line(sample, 0);
    const hal::DriveSample again = read(line.substr(0, line.size() - 1) + "\r");
    UNSIGNED_LONGS_EQUAL(4'000'000'000U, again.spindle_index_count);
    UNSIGNED_LONGS_EQUAL(255, again.spindle_index_number);
    CHECK(is_refused("#local (1.0) spindle_index_number=256"));
}

TEST(LocalLine, that_nobody_wrote_so_is_refused) {
    CHECK(is_refused("# 3 frames are missing here"));
    CHECK(is_refused("#local (1.0)\rx"));
    CHECK(is_refused("#local (1.0)x"));
    CHECK(is_refused("#local (1.0) x_velocity_mm_s=inf"));
    CHECK(is_refused("#local (1.0) spindle_current_A=A"));
    CHECK_FALSE(is_local_line("# 3 frames are missing here"));
    CHECK(is_local_line("#local (1.0) spindle_count=1"));
    CHECK(is_refused("#local (1.0 spindle_count=1"));
    CHECK(is_refused("#local (1.0) spindle_count"));
    CHECK(is_refused("#local (1.0) spindle_count=-1"));
    CHECK(is_refused("#local (1.0) spindle_count=1x"));
    CHECK(is_refused("#local (1.0) x_current_A=nan"));
    CHECK(is_refused("#local (1.0) w_current_A=1"));
    CHECK(is_refused("#local (1.0)  x_current_A=1"));
}
