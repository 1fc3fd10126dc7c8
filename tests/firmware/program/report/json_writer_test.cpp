// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <limits>
#include <string>

#include "json_check.hpp"
#include "report/json_writer.hpp"

using millforce::host::JsonCheck;
using millforce::host::JsonWriter;

namespace {

std::string text_of(std::string_view value) {
    JsonWriter json;
    return json.text(value).str();
}

std::string decimal_of(double value, int places) {
    JsonWriter json;
    return json.decimal(value, places).str();
}

std::string number_of(double value) {
    JsonWriter json;
    return json.number(value).str();
}

}  // namespace

TEST_GROUP(JsonWriter){};

TEST(JsonWriter, TheCheckOfTheseTestsTellsValidFromInvalid) {
    CHECK(JsonCheck::valid(R"({"a": [1, -2.5e-3, null, "x\u00e9\n"], "b": {}})"));
    for (const char* broken : {"", "{", "[1,]", "{\"a\":}", "nan", "[1 2]", "\"\n\"", "01", "1.", "[1]]", "\"\\x\""}) {
        CHECK_FALSE(JsonCheck::valid(broken));
    }
}

TEST(JsonWriter, CommasStandBetweenMembersOnly) {
    JsonWriter json;
    json.begin_object().key("a").begin_array().integer(1).integer(-2).end_array();
    json.key("b").begin_object().end_object().key("c").boolean(true).end_object();
    STRCMP_EQUAL(R"({"a":[1,-2],"b":{},"c":true})", json.str().c_str());
}

TEST(JsonWriter, IndentedTextIsValid) {
    JsonWriter json(JsonWriter::Style::indented);
    json.begin_object().key("a").begin_array().null().text("x").end_array().key("b").number(0.5).end_object();
    STRCMP_EQUAL("{\n  \"a\": [\n    null,\n    \"x\"\n  ],\n  \"b\": 0.5\n}", json.str().c_str());
    CHECK(JsonCheck::valid(json.str()));
}

TEST(JsonWriter, NoNumberIsNull) {
    for (const double none : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()}) {
        STRCMP_EQUAL("null", number_of(none).c_str());
        STRCMP_EQUAL("null", decimal_of(none, 2).c_str());
    }
}

TEST(JsonWriter, DecimalsAreRoundedAndShort) {
    STRCMP_EQUAL("12.35", decimal_of(12.3456, 2).c_str());
    STRCMP_EQUAL("12", decimal_of(12.0004, 3).c_str());
    STRCMP_EQUAL("1200", decimal_of(1200.0, 0).c_str());
    STRCMP_EQUAL("0", decimal_of(-0.0004, 2).c_str());
    CHECK(JsonCheck::valid(decimal_of(1e300, 3)));
    CHECK(decimal_of(1e300, 3).size() < 20);
}

TEST(JsonWriter, QuotesBackslashesAndControlCharactersAreEscaped) {
    STRCMP_EQUAL("\"say \\\"a\\\\b\\\"\\n\\t\\u0001\"", text_of("say \"a\\b\"\n\t\x01").c_str());
    CHECK(JsonCheck::valid(text_of(std::string_view("\0\r\x1f\x7f", 4))));
}

TEST(JsonWriter, NoTextCanEndAScriptElement) {
    const std::string text = text_of("</script><!-- & \u2028");
    CHECK(JsonCheck::valid(text));
    CHECK(text.find_first_of("<>&") == std::string::npos);
    CHECK(text.find("\u2028") == std::string::npos);
}

TEST(JsonWriter, TextKeepsItsUtf8AndReplacesWhatIsNone) {
    STRCMP_EQUAL("\"Ø10 mm, 30°, 𝛼\"", text_of("Ø10 mm, 30°, 𝛼").c_str());
    STRCMP_EQUAL("\"a\\ufffdb\"", text_of("a\xff"
                                          "b")
                                      .c_str());
    STRCMP_EQUAL("\"\\ufffd\\ufffd\"", text_of("\xc0\xaf").c_str());             // overlong '/'
    STRCMP_EQUAL("\"\\ufffd\\ufffd\\ufffd\"", text_of("\xed\xa0\x80").c_str());  // surrogate
    STRCMP_EQUAL("\"x\\ufffd\\ufffd\"", text_of("x\xe2\x82").c_str());           // cut off
}
