// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "../cutting/random_numbers.hpp"
#include "cnc/cnc.hpp"
#include "parsing.hpp"

// Behind Eigen: it replaces operator new by a macro.
#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::sim;

namespace {

const std::string valid_program =
    "%\n(facing) N10 G21 G90 G17 G40 G94\nN20 S4000 M3 F1200\nG0 X0 Y0 Z5\nZ1\nG1 Z-1.5 F300\nX40.125 F900\n"
    "G3 X50 Y9.875 I0 J9.875\nG2 X60 Y19.875 R10\nG91 G1 X-5 Y-2.5\n; relative\nG2 X2 Y0 I1 J0 Z-.25\nG90\n"
    "G20 G1 X1 Y1\nG21 G4 P0.5\n/X99\nS3000\nG1 X0 Y0\nG0 Z5 M5\nM30\n%\n";

/// Whether a text is a program; where it is, that it is a sane one.
bool is_sane_program(const std::string& text) {
    std::vector<Move> moves;
    try {
        moves = parse(text);
    } catch (const InputError& error) {
        const std::string message = error.what();
        CHECK(message.starts_with("part.ngc:"));
        CHECK(message.find('\n') == std::string::npos);
        CHECK(message.size() < 300);
        return false;
    }
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (const Move& move : moves) {
        CHECK(move.end_mm.allFinite() && move.centre_mm.allFinite() && move.end_mm.norm() < 2e5);
        CHECK(move.start_mm == at);
        const double length = length_mm(move);
        CHECK(std::isfinite(length) && (length > 0.0) != (move.kind == MoveKind::dwell));
        DOUBLES_EQUAL(0.0, (position_at(move, 0.0) - move.start_mm).norm(), 1e-9);
        CHECK(position_at(move, length) == move.end_mm);
        CHECK((position_at(move, 0.999999 * length) - move.end_mm).norm() <= 1.001e-6 * length + 1e-9);
        at = move.end_mm;
    }
    if (!moves.empty()) {
        Cnc cnc(CncSettings{}, moves);  // and the machine takes it
        for (int k = 0; k < 60; ++k) {
            cnc.step(1.0, false);
            CHECK(cnc.position_mm().allFinite());
        }
    }
    return true;
}

std::string random_bytes(RandomNumbers& random) {
    std::string text(random.whole(0, 200), ' ');
    for (char& c : text) {
        c = static_cast<char>(random.whole(0, 255));
    }
    return text;
}

std::string random_words(RandomNumbers& random) {
    constexpr std::string_view letters = "GGGXYZIJRFSMNPQ()%;/\n\n\r .-+";
    constexpr std::string_view digits = "0123456789.-";
    std::string text = "M3 S500 F500\n";
    for (std::size_t k = random.whole(0, 80); k > 0; --k) {
        text += letters[random.whole(0, letters.size() - 1)];
        for (std::size_t n = random.whole(0, 3); n > 0; --n) {
            text += digits[random.whole(0, digits.size() - 1)];
        }
    }
    return text + "\nM2\n";
}

std::string mutated(std::string text, RandomNumbers& random) {
    for (std::size_t k = random.whole(1, 3); k > 0 && !text.empty(); --k) {
        const std::size_t place = random.whole(0, text.size() - 1);
        switch (random.whole(0, 9)) {
            case 0:
                text[place] = static_cast<char>(random.whole(0, 255));
                break;
            case 1:
                text.erase(place, random.whole(1, 8));
                break;
            case 2:
                text.insert(place, 1, "0123456789.-GXYIJR\r\n"[random.whole(0, 19)]);
                break;
            case 3:
                text.insert(place, text.substr(random.whole(0, text.size() - 1), random.whole(1, 40)));
                break;
            case 4:
                text.resize(place);
                break;
            default:  // a digit for a digit: most of these stay programs
                if (text[place] >= '0' && text[place] <= '9') {
                    text[place] = "0123456789"[random.whole(0, 9)];
                }
        }
    }
    return text;
}

}  // namespace

TEST_GROUP(GcodeFuzz){};

TEST(GcodeFuzz, the_program_that_is_mutated_is_valid) {
    CHECK(is_sane_program(valid_program));
}

TEST(GcodeFuzz, ten_thousand_random_byte_strings_are_refused_in_one_line_or_sane) {
    RandomNumbers random(1);
    for (int k = 0; k < 10000; ++k) {
        is_sane_program(random_bytes(random));
    }
}

TEST(GcodeFuzz, ten_thousand_programs_of_random_words_are_refused_in_one_line_or_sane) {
    RandomNumbers random(2);
    for (int k = 0; k < 10000; ++k) {
        is_sane_program(random_words(random));
    }
}

TEST(GcodeFuzz, ten_thousand_mutated_programs_are_refused_in_one_line_or_sane) {
    RandomNumbers random(3);
    int sane = 0;
    for (int k = 0; k < 10000; ++k) {
        sane += is_sane_program(mutated(valid_program, random)) ? 1 : 0;
    }
    CHECK(sane > 1000);  // so the test reaches behind the parser
    CHECK(sane < 9000);
}
