// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "local_link/messages.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::local_link;

namespace {

SampleMessage a_sample() {
    SampleMessage m;
    m.sequence = 0x01020304;
    m.time_us = 0xFFFFFFFE;
    m.spindle_count = 70000;
    m.spindle_index_count = 65536;
    m.spindle_index_number = 9;
    m.present = 0x1F;
    m.rapid = true;
    m.reset = true;
    m.spindle_current_A = 3.25F;
    m.axis_current_A = {1.0F, -2.0F, 0.5F};
    m.axis_velocity_mm_s = {-25.0F, 0.0F, 4.0F};
    m.programmed_feed_mm_s = 25.0F;
    m.operator_limit = 0.5F;
    m.line = 258;
    m.distance_to_go_mm = 12.5F;
    m.tool = 70'007;
    m.commanded_speed_rad_s = 314.25F;
    return m;
}

OverrideMessage an_override() {
    OverrideMessage m;
    m.sequence = 77;
    m.heartbeat = 76;
    m.ratio = 0.62F;
    m.hold = false;
    m.tool_unknown = true;
    m.state = 2;
    m.limit = 1;
    m.tangential_N = 210.0F;
    m.axial_depth_mm = std::numeric_limits<float>::quiet_NaN();
    return m;
}

}  // namespace

TEST_GROUP(LocalLink){};

TEST(LocalLink, gives_a_sample_back_as_it_was) {
    SampleMessage got;
    CHECK(decode(encode(a_sample()), got) == MessageError::none);
    const SampleMessage sent = a_sample();
    UNSIGNED_LONGS_EQUAL(sent.sequence, got.sequence);
    UNSIGNED_LONGS_EQUAL(sent.time_us, got.time_us);
    UNSIGNED_LONGS_EQUAL(sent.spindle_count, got.spindle_count);
    UNSIGNED_LONGS_EQUAL(sent.spindle_index_count, got.spindle_index_count);
    UNSIGNED_LONGS_EQUAL(sent.spindle_index_number, got.spindle_index_number);
    UNSIGNED_LONGS_EQUAL(sent.present, got.present);
    CHECK(got.rapid && got.reset && !got.feed_hold);
    CHECK(got.spindle_current_A == sent.spindle_current_A);
    CHECK(got.axis_current_A == sent.axis_current_A);
    CHECK(got.axis_velocity_mm_s == sent.axis_velocity_mm_s);
    CHECK(got.programmed_feed_mm_s == sent.programmed_feed_mm_s && got.operator_limit == sent.operator_limit);
    CHECK(got.line == sent.line && got.distance_to_go_mm == sent.distance_to_go_mm);
    UNSIGNED_LONGS_EQUAL(sent.tool, got.tool);
    CHECK(got.commanded_speed_rad_s == sent.commanded_speed_rad_s);
}

TEST(LocalLink, stands_on_the_wire_as_the_table_says) {
    const SampleBytes bytes = encode(a_sample());
    MEMCMP_EQUAL("MFLK\x04\x00\x01\x00\x04\x03\x02\x01\xFE\xFF\xFF\xFF", bytes.data(), 16);
    BYTES_EQUAL(9, bytes[24]);
    BYTES_EQUAL(0x1F, bytes[25]);
    BYTES_EQUAL(5, bytes[26]);                                               // rapid and reset
    MEMCMP_EQUAL("\x00\x00\x50\x40", bytes.data() + 28, 4);                  // 3.25
    MEMCMP_EQUAL("\x00\x00\xC8\xC1", bytes.data() + 44, 4);                  // -25
    MEMCMP_EQUAL("\x02\x01\x00\x00\x00\x00\x48\x41", bytes.data() + 64, 8);  // 258, 12.5
    MEMCMP_EQUAL("\x77\x11\x01\x00", bytes.data() + 72, 4);                  // 70 007
    MEMCMP_EQUAL("\x00\x20\x9D\x43", bytes.data() + 76, 4);                  // 314.25
    const OverrideBytes answer = encode(an_override());
    MEMCMP_EQUAL("MFLK\x04\x00\x02\x00", answer.data(), 8);
    BYTES_EQUAL(77, answer[8]);
    BYTES_EQUAL(76, answer[12]);
    BYTES_EQUAL(2, answer[20]);  // no hold, tool not known
    BYTES_EQUAL(2, answer[21]);
}

TEST(LocalLink, gives_an_override_and_what_is_no_estimate_back) {
    OverrideMessage got;
    CHECK(decode(encode(an_override()), got) == MessageError::none);
    CHECK(got.ratio == 0.62F && !got.hold && got.tool_unknown && got.state == 2 && got.limit == 1 &&
          got.tangential_N == 210.0F);
    CHECK(std::isnan(got.axial_depth_mm));
}

TEST(LocalLink, sends_a_ratio_that_is_none_as_a_stop) {
    for (const float ratio : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.1F}) {
        OverrideMessage wrong = an_override();
        wrong.ratio = ratio;
        OverrideMessage got;
        CHECK(decode(encode(wrong), got) == MessageError::none);
        CHECK(got.hold && got.ratio == 0.0F);
    }
}

TEST(LocalLink, names_what_is_wrong_and_keeps_the_last_message) {
    const OverrideBytes good = encode(an_override());
    OverrideMessage kept = an_override();
    const auto error_with = [&](std::size_t place, std::uint8_t value) {
        OverrideBytes bytes = good;
        bytes[place] = value;
        return decode(bytes, kept);
    };
    CHECK(error_with(0, 'X') == MessageError::not_this_link);
    CHECK(error_with(4, 1) == MessageError::version);
    CHECK(error_with(6, 1) == MessageError::kind);
    CHECK(error_with(20, 4) == MessageError::reserved_bits);
    CHECK(error_with(19, 0xBF) == MessageError::not_a_ratio);  // its sign
    CHECK(decode(std::span<const std::uint8_t>(good).first(51), kept) == MessageError::length);
    CHECK(decode(std::span<const std::uint8_t>(), kept) == MessageError::length);
    CHECK(kept.ratio == 0.62F && kept.sequence == 77);
    SampleBytes sample = encode(a_sample());
    SampleMessage kept_sample;
    for (const std::size_t place : {25U, 26U, 27U}) {
        SampleBytes bytes = sample;
        bytes[place] = 0x80;
        CHECK(decode(bytes, kept_sample) == MessageError::reserved_bits);
    }
    UNSIGNED_LONGS_EQUAL(0, kept_sample.sequence);
}

TEST(LocalLink, names_an_older_version_by_its_version_and_not_by_its_length) {
    constexpr std::size_t sample_bytes_of_layout_2 = 72;
    SampleBytes bytes = encode(a_sample());
    bytes[4] = 2;
    SampleMessage got;
    CHECK(decode(std::span<const std::uint8_t>(bytes).first(sample_bytes_of_layout_2), got) == MessageError::version);
    bytes[4] = layout_version;
    CHECK(decode(std::span<const std::uint8_t>(bytes).first(sample_bytes_of_layout_2), got) == MessageError::length);
    STRCMP_EQUAL("another version of the layout", name(MessageError::version));
}

TEST(LocalLink, takes_any_bytes_and_lets_no_ratio_through_that_is_none) {
    std::mt19937 random(1);
    const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
    unsigned taken = 0;
    for (int round = 0; round < 200'000; ++round) {
        OverrideBytes bytes = encode(an_override());
        std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());
        for (std::size_t k = 0; k < 1 + random() % 8; ++k) {
            sent[random() % sent.size()] = byte();
        }
        if (random() % 16 == 0) {
            sent.resize(random() % 70, byte());
        }
        OverrideMessage got;
        if (decode(sent, got) == MessageError::none) {
            ++taken;
            CHECK(std::isfinite(got.ratio) && got.ratio >= 0.0F);
        }
        SampleMessage sample;
        CHECK(decode(sent, sample) != MessageError::none);
    }
    CHECK(taken > 10'000);
}
