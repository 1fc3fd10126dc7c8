// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "bus_settings.hpp"
#include "candump/log_line.hpp"
#include "cia402/drive_bus.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

/// A listener with one drive, the spindle at node 1.
cia402::BusSettings spindle_alone() {
    cia402::BusSettings settings = test::a_bus();
    cia402::DriveSettings& spindle = settings.drives[0];
    spindle.node_id = 1;
    spindle.rated_current_A = 10.0F;
    spindle.pdos[0].id = 0x181;
    spindle.pdos[0].object_count = 2;
    spindle.pdos[0].objects = {cia402::MappedObject{cia402::object::position_actual, 0, 32},
                               cia402::MappedObject{cia402::object::current_actual, 0, 16}};
    return settings;
}

std::string line_of(int time_us, const char* frame) {
    std::array<char, 80> line{};
    std::snprintf(line.data(), line.size(), "(1700000000.%06d) can0 %s", time_us, frame);
    return line.data();
}

}  // namespace

TEST_GROUP(Replay){};

TEST(Replay, a_candump_log_gives_the_samples_that_the_bus_gave) {
    std::vector<std::string> log{"# recorded on the machine"};
    for (int k = 0; k < 100; ++k) {
        log.push_back(line_of(1000 * k, "080#"));
        log.push_back(line_of(1000 * k + 150, "181#00100000F401"));
        log.push_back(line_of(1000 * k + 300, k % 2 == 0 ? "123##1AABB" : "20000080#0000000000000000"));
    }
    cia402::DriveBus bus(spindle_alone());
    std::vector<hal::DriveSample> samples;
    for (const std::string& text : log) {
        const candump::LogLine line = candump::read_line(text);
        CHECK(line.kind != candump::LineKind::malformed);
        if (line.kind == candump::LineKind::blank) {
            continue;
        }
        bus.poll(line.time_us);
        if (line.kind == candump::LineKind::frame) {
            bus.on_frame(line.frame, line.time_us);
        }
        hal::DriveSample sample;
        if (bus.take_sample(sample)) {
            samples.push_back(sample);
        }
    }
    CHECK_EQUAL(100U, samples.size());
    DOUBLES_EQUAL(5.0, samples.back().spindle_current_A, 1e-5);
    UNSIGNED_LONGS_EQUAL(4096, samples.back().spindle_count);
    UNSIGNED_LONGS_EQUAL(1000, samples[1].time_us - samples[0].time_us);
    CHECK_EQUAL(0U, bus.rejects().total());
}
