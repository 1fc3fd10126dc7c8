// SPDX-License-Identifier: Apache-2.0
#include "files/printable.hpp"
#include "files/input_error.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;

TEST_GROUP(Printable){};

TEST(Printable, leaves_nothing_that_a_terminal_obeys) {
    STRCMP_EQUAL("a?[31m??b", printable("a\x1b[31m\r\nb").c_str());
    STRCMP_EQUAL("?", printable("\x7f").c_str());
    STRCMP_EQUAL("?31m", printable("\xC2\x9B"
                                   "31m")
                             .c_str());  // U+009B does what ESC [ does
    STRCMP_EQUAL("µ", printable("µ").c_str());
}

TEST(Printable, shows_at_most_sixty_bytes) {
    STRCMP_EQUAL(std::string(60, 'a').c_str(), printable(std::string(60, 'a')).c_str());
    STRCMP_EQUAL((std::string(60, 'a') + "…").c_str(), printable(std::string(61, 'a')).c_str());
}

TEST(Printable, is_what_every_refusal_says) {
    STRCMP_EQUAL("file?.csv: no such file", InputError("file\n.csv: no such file").what());
}
