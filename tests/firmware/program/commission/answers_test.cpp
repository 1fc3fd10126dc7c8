// SPDX-License-Identifier: Apache-2.0
#include "commission/answers.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <sstream>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {
const NumberQuestion diameter{"tool.diameter_mm", "Cutting diameter", "mm", 0.1, 1000.0};
const NumberQuestion helix{"tool.helix_deg", "Helix", "°", 0.0, 60.0, 30.0};
const WordQuestion material{"tool.material", "Material", {"carbide", "hss"}, {}};
}  // namespace

TEST_GROUP(Answers) {
    TemporaryFolder folder;
    std::string file(const std::string& text) {
        folder.write("answers.toml", text);
        return folder.path("answers.toml");
    }
};

TEST(Answers, the_command_line_comes_before_the_file_and_the_file_before_the_usual_value) {
    Answers answers(file("[tool]\ndiameter_mm = 8\nhelix_deg = 45\n"), {"tool.diameter_mm=10", "tool.material=hss"});
    DOUBLES_EQUAL(10.0, answers.number(diameter), 0.0);
    DOUBLES_EQUAL(45.0, answers.number(helix), 0.0);
    STRCMP_EQUAL("hss", answers.word(material).c_str());
    answers.require_all();
}

TEST(Answers, names_every_missing_answer_at_once) {
    Answers answers("", {});
    CHECK(std::isnan(answers.number(diameter)));
    DOUBLES_EQUAL(30.0, answers.number(helix), 0.0);
    answers.word(material);
    STRCMP_EQUAL(
        "missing answers: tool.diameter_mm in mm, tool.material (carbide, hss); give each as KEY=VALUE or in "
        "--answers FILE",
        message_of<InputError>([&] { answers.require_all(); }).c_str());
}

TEST(Answers, an_answer_that_nobody_asked_for_is_refused_with_the_nearest_key) {
    Answers answers("", {"tool.dimeter_mm=10"});
    DOUBLES_EQUAL(30.0, answers.number(helix), 0.0);
    NumberQuestion with_usual = diameter;
    with_usual.usual = 10.0;
    answers.number(with_usual);
    CHECK(contains(message_of<InputError>([&] { answers.require_all(); }), "did you mean diameter_mm?"));
}

TEST(Answers, a_misspelt_key_is_named_beside_the_answer_that_is_missing_for_it) {
    Answers answers("", {"tool.dimeter_mm=10"});
    answers.number(diameter);
    const std::string message = message_of<InputError>([&] { answers.require_all(); });
    CHECK_TEXT(contains(message, "missing answer: tool.diameter_mm in mm"), message.c_str());
    CHECK_TEXT(contains(message, "did you mean diameter_mm?"), message.c_str());
}

TEST(Answers, refuses_a_value_out_of_range_and_a_pair_that_is_none) {
    Answers answers("", {"tool.diameter_mm=-1"});
    CHECK(contains(message_of<InputError>([&] { answers.number(diameter); }), "0.1"));
    for (const char* pair : {"tool.diameter_mm", "=3", "tool[0]=3", "a b=3", "x\n[y]=3"}) {
        CHECK(contains(message_of<InputError>([&] { Answers("", {pair}); }), "expected KEY=VALUE"));
    }
}

TEST(Answers, asks_on_a_terminal_until_the_value_is_allowed) {
    std::istringstream in("ten\n0\n12.5\n\nplastic\ncarbide\n");
    std::ostringstream out;
    Answers answers("", {});
    answers.ask_on(in, out);
    DOUBLES_EQUAL(12.5, answers.number(diameter), 0.0);
    DOUBLES_EQUAL(30.0, answers.number(helix), 0.0);
    STRCMP_EQUAL("carbide", answers.word(material).c_str());
    CHECK(contains(out.str(), "expected a number from 0.1 to 1000 mm"));
    CHECK(contains(out.str(), "Helix, ° [30]: "));
}

TEST(Answers, of_an_earlier_run_answer_the_same_questions_again) {
    Answers first("", {"tool.diameter_mm=10", "tool.material=carbide"});
    first.number(diameter);
    first.word(material);
    Answers second("", {});
    second.add_known(file(first.text() + "of.something_else = 3\n"));
    DOUBLES_EQUAL(10.0, second.number(diameter), 0.0);
    STRCMP_EQUAL("carbide", second.word(material).c_str());
    second.require_all();
}

TEST(Answers, asks_for_a_whole_number_until_it_is_one_and_for_a_number_without_anything_behind_it) {
    std::istringstream in("3.5\n20\n3 teeth\n4\n");
    std::ostringstream out;
    Answers answers("", {});
    answers.ask_on(in, out);
    LONGS_EQUAL(4, answers.integer({"tool.teeth", "Teeth", "", 1.0, 16.0}));
    STRCMP_EQUAL(
        "Teeth:   expected a whole number from 1 to 16\nTeeth:   expected a whole number from 1 to 16\n"
        "Teeth:   expected a whole number from 1 to 16\nTeeth: ",
        out.str().c_str());
}

TEST(Answers, takes_any_word_where_there_are_no_choices_and_the_usual_one_for_an_empty_line) {
    std::istringstream in("\nfree text\n\n");
    std::ostringstream out;
    Answers answers("", {});
    answers.ask_on(in, out);
    STRCMP_EQUAL("free text", answers.word({"name", "Name", {}, {}}).c_str());
    STRCMP_EQUAL("hss", answers.word({"tool.material", "Material", {"carbide", "hss"}, "hss"}).c_str());
    STRCMP_CONTAINS("Material (carbide, hss) [hss]: ", out.str().c_str());
    STRCMP_EQUAL("of the pair", Answers("", {"name=of the pair"}).word({"name", "Name", {}, {}}).c_str());
}

TEST(Answers, on_a_terminal_that_is_closed_are_missing_and_are_not_asked_for_again) {
    std::istringstream in("");
    std::ostringstream out;
    Answers answers("", {});
    answers.ask_on(in, out);
    CHECK(std::isnan(answers.number(diameter)));
    CHECK_FALSE(answers.asks());
    STRCMP_EQUAL("", answers.word(material).c_str());
    STRCMP_CONTAINS("missing answers: tool.diameter_mm in mm, tool.material (carbide, hss)",
                    message_of<InputError>([&] { answers.require_all(); }).c_str());
}
