// SPDX-License-Identifier: Apache-2.0
#include "iio/scan_format.hpp"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce::iio;

TEST_GROUP(ScanFormat){};

TEST(ScanFormat, is_read_as_the_kernel_writes_it) {
    CHECK(parse_scan_format("le:s12/16>>4") == (ScanFormat{false, true, 12, 16, 1, 4}));
    CHECK(parse_scan_format("be:u24/32>>8") == (ScanFormat{true, false, 24, 32, 1, 8}));
    CHECK(parse_scan_format("le:s64/64>>0") == (ScanFormat{false, true, 64, 64, 1, 0}));
    CHECK(parse_scan_format("le:s16/32X4>>0") == (ScanFormat{false, true, 16, 32, 4, 0}));
}

TEST(ScanFormat, that_no_channel_can_have_is_none) {
    for (const char* text : {"",
                             "le",
                             "le:",
                             "xe:s12/16>>4",
                             "le:x12/16>>4",
                             "le:s12",
                             "le:s12/16",
                             "le:s12/16>>",
                             "le:s12/16>>5",
                             "le:s0/16>>0",
                             "le:s17/16>>0",
                             "le:s12/12>>0",
                             "le:s12/24>>0",
                             "le:s12/16>>4 ",
                             "le:s12/16>>-1",
                             "le:s300/16>>0",
                             "le:s12/16X0>>0",
                             "le:s12/16X17>>0",
                             "le:s12/16>>4>>4",
                             "LE:s12/16>>4",
                             "le:s+12/16>>4"}) {
        CHECK_FALSE_TEXT(parse_scan_format(text).has_value(), text);
    }
}

TEST(ScanFormat, decodes_sign_shift_and_byte_order) {
    const std::array<std::uint8_t, 4> bytes{0xF0, 0x80, 0x12, 0x34};
    LONGS_EQUAL(-2033, decode(bytes, *parse_scan_format("le:s12/16>>4")));
    LONGS_EQUAL(0x80F, decode(bytes, *parse_scan_format("le:u12/16>>4")));
    LONGS_EQUAL(0xF080, decode(bytes, *parse_scan_format("be:u16/16>>0")));
    LONGS_EQUAL(0xF08012, decode(bytes, *parse_scan_format("be:u24/32>>8")));
    LONGS_EQUAL(-0x10, decode(bytes, *parse_scan_format("le:s8/8>>0")));
}

TEST(ScanFormat, decodes_every_width_back_to_what_went_in) {
    std::mt19937_64 random(5);
    for (unsigned bits = 1; bits <= 63; ++bits) {
        for (const bool is_signed : {false, true}) {
            const unsigned shift = 64 - bits;
            const ScanFormat format{false, is_signed, static_cast<std::uint8_t>(bits),
                                    64,    1,         static_cast<std::uint8_t>(shift)};
            const std::uint64_t pattern = random() >> shift;
            const bool is_negative = is_signed && (pattern >> (bits - 1)) != 0;
            const auto value = static_cast<std::int64_t>(is_negative ? pattern | (~std::uint64_t{0} << bits) : pattern);
            std::array<std::uint8_t, 8> bytes{};
            for (unsigned k = 0; k < 8; ++k) {
                bytes[k] = static_cast<std::uint8_t>((pattern << shift) >> (8U * k));
            }
            CHECK(decode(bytes, format) == value);
        }
    }
}

TEST(ScanFormat, knows_the_ends_of_its_range) {
    const ScanFormat u12 = *parse_scan_format("le:u12/16>>0");
    CHECK(is_at_rail(0, u12) && is_at_rail(4095, u12) && !is_at_rail(1, u12) && !is_at_rail(4094, u12));
    const ScanFormat s12 = *parse_scan_format("le:s12/16>>0");
    CHECK(is_at_rail(-2048, s12) && is_at_rail(2047, s12) && !is_at_rail(0, s12));
}

TEST(ScanFormat, fuzz_never_gives_a_format_beyond_its_ranges) {
    std::mt19937 random(3);
    const std::string letters = "lebsu:/X>0123456789 -";
    int formats = 0;
    for (int k = 0; k < 100'000; ++k) {
        std::string text = "le:s12/16>>4";
        for (unsigned changes = 1 + static_cast<unsigned>(random() % 3); changes > 0; --changes) {
            text[random() % text.size()] = letters[random() % letters.size()];
        }
        const auto format = parse_scan_format(text);
        if (format) {
            ++formats;
            CHECK(format->bits > 0 && format->bits + format->shift <= format->storage_bits && format->bytes() <= 128);
            const std::int64_t value = decode(std::vector<std::uint8_t>(3, 0xFF), *format);
            CHECK(format->bits > 62 ||
                  (value < (std::int64_t{1} << format->bits) && value >= -(std::int64_t{1} << format->bits)));
        }
    }
    CHECK(formats > 1000);
}
