// SPDX-License-Identifier: Apache-2.0
#include "import/dbc.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <bit>
#include <cmath>
#include <random>

using namespace millforce::host;
using namespace millforce::test;
using millforce::hal::CanFrame;

namespace {

CanFrame frame_of(std::initializer_list<std::uint8_t> bytes) {
    CanFrame frame;
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    frame.length = static_cast<std::uint8_t>(bytes.size());
    return frame;
}

/// A file with one message of 8 bytes.
Dbc with_signals(const std::string& signals) {
    return Dbc::from_text("BO_ 496 Motor: 8 Drive\n" + signals, "a.dbc");
}

double decoded(const std::string& place, const CanFrame& frame) {
    return with_signals(" SG_ S : " + place + " [0|0] \"\" X\n").find("S", "map").decode(frame);
}

std::string error_of(const std::string& text, const std::string& name = "S") {
    return message_of<InputError>([&] { static_cast<void>(Dbc::from_text(text, "a.dbc").find(name, "map")); });
}

}  // namespace

TEST_GROUP(Dbc){};

TEST(Dbc, decodes_the_example_that_cantools_publishes) {
    const Dbc dbc = with_signals(
        " SG_ Temperature : 0|12@0- (0.01,250) [229.52|270.47] \"degK\" PCM1,FOO\n"
        " SG_ AverageRadius : 6|6@0+ (0.1,0) [0|5] \"m\" Vector__XXX\n"
        " SG_ Enable : 7|1@0+ (1,0) [0|0] \"-\" Vector__XXX\n");
    const CanFrame frame = frame_of({0xC0, 0x06, 0xE0, 0, 0, 0, 0, 0});
    DOUBLES_EQUAL(250.55, dbc.find("Temperature", "map").decode(frame), 1e-9);
    DOUBLES_EQUAL(3.2, dbc.find("Motor.AverageRadius", "map").decode(frame), 1e-9);
    DOUBLES_EQUAL(1.0, dbc.find("Enable", "map").decode(frame), 0.0);
}

TEST(Dbc, reads_both_byte_orders_signed_and_unsigned) {
    const CanFrame frame = frame_of({0x12, 0x34, 0xFE, 0xFF, 0x80, 0x00, 0xFF, 0x7F});
    DOUBLES_EQUAL(0x3412, decoded("0|16@1+ (1,0)", frame), 0.0);
    DOUBLES_EQUAL(0x1234, decoded("7|16@0+ (1,0)", frame), 0.0);
    DOUBLES_EQUAL(-2, decoded("16|16@1- (1,0)", frame), 0.0);
    DOUBLES_EQUAL(-32768, decoded("39|16@0- (1,0)", frame), 0.0);
    DOUBLES_EQUAL(-16384 + 5, decoded("39|16@0- (0.5,5)", frame), 0.0);
    DOUBLES_EQUAL(0x2, decoded("4|4@1+ (2,0)", frame), 0.0);
}

TEST(Dbc, agrees_with_whole_words_at_every_place_of_both_orders) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 200; ++round) {
        const std::uint64_t word = random();
        CanFrame little;
        CanFrame big;
        little.length = big.length = 8;
        for (unsigned byte = 0; byte < 8; ++byte) {
            little.data[byte] = static_cast<std::uint8_t>(word >> (8 * byte));
            big.data[7 - byte] = little.data[byte];
        }
        const unsigned bits = 1 + static_cast<unsigned>(random() % 48);
        const unsigned shift = static_cast<unsigned>(random() % (64 - bits));
        const auto expected = static_cast<double>((word >> shift) & ((std::uint64_t{1} << bits) - 1));
        const unsigned highest = shift + bits - 1;
        const unsigned motorola_start = 8 * (7 - highest / 8) + highest % 8;
        const std::string length = "|" + std::to_string(bits);
        DOUBLES_EQUAL(expected, decoded(std::to_string(shift) + length + "@1+ (1,0)", little), 0.0);
        DOUBLES_EQUAL(expected, decoded(std::to_string(motorola_start) + length + "@0+ (1,0)", big), 0.0);
    }
}

TEST(Dbc, reads_floating_point_where_the_file_says_so) {
    const auto bits = std::bit_cast<std::uint32_t>(-12.75F);
    CanFrame frame;
    frame.length = 8;
    for (unsigned byte = 0; byte < 4; ++byte) {
        frame.data[4 + byte] = static_cast<std::uint8_t>(bits >> (8 * byte));
    }
    const Dbc dbc = with_signals(" SG_ Velocity : 32|32@1- (1,0) [0|0] \"rev/s\" X\nSIG_VALTYPE_ 496 Velocity : 1;\n");
    DOUBLES_EQUAL(-12.75, dbc.find("Velocity", "map").decode(frame), 0.0);
}

TEST(Dbc, gives_no_value_of_a_frame_that_is_too_short) {
    CHECK(std::isnan(decoded("16|16@1+ (1,0)", frame_of({1, 2, 3}))));
    DOUBLES_EQUAL(0x0403, decoded("16|16@1+ (1,0)", frame_of({1, 2, 3, 4})), 0.0);
    CHECK(std::isnan(decoded("23|16@0+ (1,0)", frame_of({1, 2, 3}))));
}

TEST(Dbc, passes_over_all_else_and_texts_that_look_like_signals) {
    const Dbc dbc = with_signals(
        " SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n"
        "CM_ BO_ 496 \"a comment:\n SG_ Ghost : 0|8@1+ (1,0) [0|0] \"\"\nBO_ nonsense\n\";\n"
        "VAL_ 496 S 0 \"off\" 1 \"on\" ;\nBO_TX_BU_ 496 : A,B;\nSG_MUL_VAL_ 496 S S 0-0;\n"
        "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n SG_ Loose : 0|8@1+ (1,0) [0|0] \"\" X\n");
    LONGS_EQUAL(1, dbc.signals().size());
}

TEST(Dbc, knows_ids_of_29_bits) {
    const Dbc dbc = Dbc::from_text("BO_ 2566844672 Engine: 8 X\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" X\n", "a.dbc");
    CHECK(dbc.find("S", "map").extended);
    LONGS_EQUAL(0x18FEF100, dbc.find("S", "map").id);
}

TEST(Dbc, names_line_column_and_what_was_expected) {
    const std::string message = "BO_ 496 Motor: 8 X\n";
    CHECK(contains(error_of(message + " SG_ S : 0|16@2+ (1,0) [0|0] \"\" X"), "a.dbc:2:15"));
    CHECK(contains(error_of(message + " SG_ S : 0|65@1+ (1,0) [0|0] \"\" X"), "integer from 0 to 64"));
    CHECK(contains(error_of(message + " SG_ S : 0|0@1+ (1,0) [0|0] \"\" X"), "at least one bit"));
    CHECK(contains(error_of(message + " SG_ S : 0|8@1+ (inf,0) [0|0] \"\" X"), "expected a number"));
    CHECK(contains(error_of(message + " SG_ S : 0|8@1+ (1,0) [0|0] \"deg"), "in quotes"));
    CHECK(contains(error_of(message + " SG_ 1S : 0|8@1+ (1,0) [0|0] \"\" X"), "a name"));
    CHECK(contains(error_of(" SG_ S : 0|8@1+ (1,0) [0|0] \"\" X"), "a message (BO_) before it"));
    CHECK(contains(error_of("BO_ 4294967296 Motor: 8 X\n"), "an integer"));
    CHECK(contains(error_of("VERSION \"\"\n"), "no signals"));
}

TEST(Dbc, refuses_a_signal_that_it_cannot_decode_only_where_it_is_asked_for) {
    const std::string message = "BO_ 496 Motor: 8 X\n SG_ Fine : 0|8@1+ (1,0) [0|0] \"\" X\n";
    const auto error_with = [&](const std::string& line) {
        const std::string text = message + line;
        CHECK(error_of(text, "Fine").empty());
        return error_of(text);
    };
    CHECK(contains(error_with(" SG_ S m2 : 8|8@1+ (1,0) [0|0] \"\" X\n"), "multiplexed"));
    CHECK(contains(error_with(" SG_ S : 60|8@1+ (1,0) [0|0] \"\" X\n"), "up to byte 9, and its message has 8"));
    CHECK(contains(error_with(" SG_ S : 56|16@0+ (1,0) [0|0] \"\" X\n"), "up to byte"));
    CHECK(contains(error_with("BO_ 497 Long: 64 X\n SG_ S : 8|8@1+ (1,0) [0|0] \"\" X\n"),
                   "64 bytes, expected at most 8"));
    CHECK(contains(
        error_with("SIG_VALTYPE_ 496 Other : 2;\n SG_ S : 8|16@1+ (1,0) [0|0] \"\" X\nSIG_VALTYPE_ 496 S : 1;"),
        "16 bits, expected 32"));
    CHECK(contains(error_with(" SG_ Spedd : 8|8@1+ (1,0) [0|0] \"\" X\n"), "no signal 'S'"));
}

TEST(Dbc, names_the_nearest_signal_and_both_messages_of_one_that_is_there_twice) {
    const std::string text =
        "BO_ 1 A: 8 X\n SG_ Current : 0|8@1+ (1,0) [0|0] \"\" X\nBO_ 2 B: 8 X\n SG_ Current : 0|8@1+ (1,0) [0|0] \"\" "
        "X\n";
    CHECK(contains(error_of(text, "A.Curent"), "the nearest is 'A.Current'"));
    CHECK(contains(error_of(text, "Current"), "in A and in B"));
    STRCMP_EQUAL("", error_of(text, "B.Current").c_str());
}

TEST(Dbc, reads_this_projects_own_file) {
    const Dbc dbc = Dbc::open(MILLFORCE_SOURCE_DIR "/drivers/millforce.dbc");
    DOUBLES_EQUAL(-0.25, dbc.find("SpindleCurrent", "map").decode(frame_of({0, 0, 0, 0, 0x06, 0xFF, 0, 0})), 1e-12);
}

TEST(Dbc, survives_any_change_of_a_character) {
    const std::string text =
        "VERSION \"\"\nBO_ 385 M: 8 X\n SG_ S m1 : 23|16@0- (0.1,0) [-1|1] \"%\" L\nSIG_VALTYPE_ 385 S : 1;\n";
    std::mt19937 random(2);
    std::size_t refused = 0;
    for (std::size_t place = 0; place < text.size(); ++place) {
        for (int round = 0; round < 20; ++round) {
            std::string changed = text;
            changed[place] = static_cast<char>(random() % 256);
            const std::string error = message_of<InputError>([&] {
                const Dbc dbc = Dbc::from_text(changed, "a");
                for (const DbcSignal& signal : dbc.signals()) {
                    static_cast<void>(signal.decode(frame_of({1, 2, 3, 4, 5, 6, 7, 8})));
                }
            });
            refused += error.empty() ? 0U : 1U;
        }
    }
    CHECK(refused > 500);
}

TEST(Dbc, reads_64_bits_as_an_integer_of_either_sign_and_as_a_double) {
    const CanFrame all_ones = frame_of({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF});
    DOUBLES_EQUAL(-1.0, decoded("0|64@1- (1,0)", all_ones), 0.0);
    const std::string of_double = " SG_ S : 0|64@1- (1,0) [0|0] \"\" X\nSIG_VALTYPE_ 496 S : 2;\n";
    const DbcSignal signal = with_signals(of_double).find("S", "map");
    DOUBLES_EQUAL(-2.5, signal.decode(frame_of({0, 0, 0, 0, 0, 0, 0x04, 0xC0})), 0.0);
    CHECK(std::isnan(signal.decode(all_ones)));  // the bits of no number
}
