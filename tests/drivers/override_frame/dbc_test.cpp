// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "override_frame/override_frame.hpp"
#include "program_status/program_status_frame.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

struct DbcSignal {
    unsigned first_bit = 0;
    unsigned bits = 0;
    double scale = 0.0;
};

/// Unsigned little-endian signals of one message.
std::map<std::string, DbcSignal> signals_of(const std::string& message) {
    std::map<std::string, DbcSignal> signals;
    std::ifstream file(MILLFORCE_SOURCE_DIR "/drivers/millforce.dbc");
    bool is_in_message = false;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("BO_ ")) {
            is_in_message = line.starts_with(message);
        }
        char name[40] = {};
        DbcSignal signal;
        if (is_in_message && std::sscanf(line.c_str(), " SG_ %39s : %u|%u@1+ (%lf", name, &signal.first_bit,
                                         &signal.bits, &signal.scale) == 4) {
            signals[name] = signal;
        }
    }
    return signals;
}

double value_of(const DbcSignal& signal, const hal::CanFrame& frame) {
    double value = 0.0;
    for (unsigned k = signal.bits; k-- > 0;) {
        const unsigned bit = signal.first_bit + k;
        value = 2.0 * value + static_cast<double>((static_cast<unsigned>(frame.data[bit / 8]) >> (bit % 8)) & 1U);
    }
    return value * signal.scale;
}

}  // namespace

TEST_GROUP(Dbc){};

TEST(Dbc, describes_the_override_frame_as_it_is_encoded) {
    auto signals = signals_of("BO_ 510 FeedOverride: 8 ");
    CHECK_EQUAL(7U, signals.size());
    UNSIGNED_LONGS_EQUAL(510, override_frame::default_id);
    const hal::CanFrame frame = override_frame::encode({1.2345F, true, 7, 3, 0xBEEF}, override_frame::default_id);
    DOUBLES_EQUAL(1.2345, value_of(signals["Ratio"], frame), 1e-9);
    DOUBLES_EQUAL(1, value_of(signals["Hold"], frame), 0);
    DOUBLES_EQUAL(0, value_of(signals["Reserved"], frame), 0);
    DOUBLES_EQUAL(7, value_of(signals["State"], frame), 0);
    DOUBLES_EQUAL(3, value_of(signals["Fault"], frame), 0);
    DOUBLES_EQUAL(0xBEEF, value_of(signals["Counter"], frame), 0);
    DOUBLES_EQUAL(frame.data[7], value_of(signals["Checksum"], frame), 0);
}

TEST(Dbc, describes_the_program_status_frame_as_it_is_encoded) {
    auto signals = signals_of("BO_ 509 ProgramStatus: 8 ");
    CHECK_EQUAL(8U, signals.size());
    UNSIGNED_LONGS_EQUAL(509, program_status::default_id);
    program_status::ProgramStatusFrame status;
    status.program = {25.0F, 0.8F, true, false};
    status.reset_fault = true;
    status.counter = 0xBEEF;
    const hal::CanFrame frame = program_status::encode(status, program_status::default_id);
    DOUBLES_EQUAL(1500.0, value_of(signals["ProgrammedFeed"], frame), 1e-9);
    DOUBLES_EQUAL(80, value_of(signals["OperatorOverride"], frame), 0);
    DOUBLES_EQUAL(1, value_of(signals["Rapid"], frame), 0);
    DOUBLES_EQUAL(0, value_of(signals["FeedHold"], frame), 0);
    DOUBLES_EQUAL(1, value_of(signals["ResetFault"], frame), 0);
    DOUBLES_EQUAL(0, value_of(signals["StatusReserved"], frame), 0);
    DOUBLES_EQUAL(0xBEEF, value_of(signals["StatusCounter"], frame), 0);
    DOUBLES_EQUAL(frame.data[7], value_of(signals["StatusChecksum"], frame), 0);
}

TEST(Dbc, describes_the_tool_frame_as_it_is_encoded) {
    auto signals = signals_of("BO_ 765 ToolInSpindle: 8 ");
    CHECK_EQUAL(3U, signals.size());
    UNSIGNED_LONGS_EQUAL(765, program_status::tool_frame_id(program_status::default_id));
    const hal::CanFrame frame = program_status::encode_tool(0xDEADBEEF, 765);
    DOUBLES_EQUAL(0xDEADBEEF, value_of(signals["ToolNumber"], frame), 0);
    DOUBLES_EQUAL(0, value_of(signals["ToolReserved"], frame), 0);
    DOUBLES_EQUAL(frame.data[7], value_of(signals["ToolChecksum"], frame), 0);
}

TEST(Dbc, describes_the_speed_frame_as_it_is_encoded) {
    auto signals = signals_of("BO_ 1277 SpindleCommand: 8 ");
    CHECK_EQUAL(3U, signals.size());
    UNSIGNED_LONGS_EQUAL(1277, program_status::speed_frame_id(program_status::default_id));
    const hal::CanFrame frame = program_status::encode_speed(314.159265F, 1277);
    DOUBLES_EQUAL(3000.0, value_of(signals["CommandedSpeed"], frame), 1e-3);
    DOUBLES_EQUAL(0, value_of(signals["SpeedReserved"], frame), 0);
    DOUBLES_EQUAL(frame.data[7], value_of(signals["SpeedChecksum"], frame), 0);
}
