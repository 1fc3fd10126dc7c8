// SPDX-License-Identifier: Apache-2.0
#include "candump/log_line.hpp"

#include <random>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::candump;

TEST_GROUP(LogLine) {
    LogLine of(const std::string& frame) {
        text = "(1436509052.249713) can0 " + frame;
        return read_line(text);
    }
    void is_malformed(const std::string& frame, LineError error) {
        const LogLine line = of(frame);
        CHECK(line.kind == LineKind::malformed);
        CHECK(line.error == error);
        CHECK(line.column > 0);
        CHECK(!expectation(error).empty());
    }
    std::string text{};  // lines refer to it
};

TEST(LogLine, a_data_frame_has_its_time_interface_id_and_bytes) {
    const LogLine line = of("181#1122334455667788");
    CHECK(line.kind == LineKind::frame);
    CHECK(line.time_us == 1436509052249713ULL);
    CHECK(line.interface == "can0");
    UNSIGNED_LONGS_EQUAL(0x181, line.frame.id);
    CHECK_FALSE(line.frame.extended);
    UNSIGNED_LONGS_EQUAL(8, line.frame.length);
    UNSIGNED_LONGS_EQUAL(0x11, line.frame.data[0]);
    UNSIGNED_LONGS_EQUAL(0x88, line.frame.data[7]);
}

TEST(LogLine, other_frames_that_candump_writes_are_read_or_told_apart) {
    CHECK(of("0000018A#").frame.extended);
    CHECK(of("181#R").frame.remote);
    UNSIGNED_LONGS_EQUAL(5, of("181#R5").frame.length);
    CHECK(of("181#11 R").kind == LineKind::frame);
    CHECK(of("181#11 T\r").kind == LineKind::frame);
    CHECK(of("181#1122334455667788_9").kind == LineKind::frame);
    CHECK(of("181#11.22.33").frame.length == 3);
    CHECK(of("123##5112233").kind == LineKind::fd_frame);
    CHECK(of("123##1" + std::string(128, 'a')).kind == LineKind::fd_frame);
    CHECK(of("20000004#0001000000000000").kind == LineKind::error_frame);
    CHECK(read_line("").kind == LineKind::blank);
    CHECK(read_line("  \r").kind == LineKind::blank);
    CHECK(read_line("# a comment").kind == LineKind::blank);
}

TEST(LogLine, what_is_wrong_is_named_with_its_place) {
    is_malformed("18#11", LineError::id);
    is_malformed("800#11", LineError::id);
    is_malformed("40000000#11", LineError::id);
    is_malformed("181 11", LineError::id);
    is_malformed("181#1", LineError::data);
    is_malformed("181#112233445566778899", LineError::data);
    is_malformed("181#R9", LineError::length);
    is_malformed("181#1122334455667788_3", LineError::length);
    is_malformed("181#11 x", LineError::rest);
    is_malformed("181#11g", LineError::rest);
    is_malformed("123##", LineError::data);
    is_malformed("123##1" + std::string(130, 'a'), LineError::data);
    is_malformed(std::string(300, ' '), LineError::too_long);
    CHECK(read_line("1436509052.249713 can0 181#11").error == LineError::time);
    CHECK(read_line("(99999999999999999999.0) can0 181#11").error == LineError::time);
    CHECK(read_line("(1.0) ").error == LineError::interface);
    CHECK(read_line("(1.0) a_name_of_16_chr 181#11").error == LineError::interface);
    UNSIGNED_LONGS_EQUAL(14, read_line("(1.0) can0 18#11").column);
}

TEST(LogLine, any_bytes_are_read_within_their_bounds) {
    std::mt19937 random(23);
    const std::string alphabet = "0123456789abcdefABCDEF#R_. ()\t\r\0\xFF";
    const std::string sound = "(1436509052.249713) can0 181#1122334455667788";
    for (int k = 0; k < 300'000; ++k) {
        std::string line_text = sound;
        for (unsigned changes = static_cast<unsigned>(random() % 6); changes > 0; --changes) {
            const std::size_t place = random() % (line_text.size() + 1);
            const char c = alphabet[random() % alphabet.size()];
            switch (random() % 3) {
                case 0:
                    line_text.insert(place, 1, c);
                    break;
                case 1:
                    line_text.erase(place, 1);
                    break;
                default:
                    line_text.resize(place, c);
                    break;
            }
        }
        const LogLine line = read_line(line_text);
        CHECK(line.frame.length <= 8);
        CHECK(line.frame.id <= 0x1FFFFFFF);
        CHECK((line.kind == LineKind::malformed) == (line.error != LineError::none));
    }
}
