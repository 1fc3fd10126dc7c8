// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/import/import_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string sampler_map = R"([source]
names = ["a", "i"]
[time_s]
rate_hz = 100
[x_current_A]
source = "i"
)";

const std::string trace_map = R"([x_current_A]
source = "/Nck/curr [1]"
[x_velocity_mm_s]
source = "f2"
)";

std::string trace_of(const std::string& records) {
    return R"(<?xml version="1.0"?><!-- saved by <hand> --><traceSession><traceCaptureSetup>
<signal name="not this one" id="f9"/></traceCaptureSetup><traceData><dataFrame><frameHeader startTime="1"/>
<dataSignal interval="0.002" id="f1" name="/Nck/curr [1]" description="current"/>
<dataSignal interval="0.004" id="f2" name="/Nck/vel &lt;1&gt;" description="velocity"/>
)" + records +
           "</dataFrame></traceData></traceSession>\n";
}

const std::string bus_map = R"([source]
dbc = "bus.dbc"
[spindle_current_A]
source = "Spindle.Current"
[x_current_A]
source = "X.Current"
)";

const std::string bus_dbc =
    "BO_ 385 Spindle: 2 S\n SG_ Current : 0|16@1- (0.1,0) [0|0] \"A\" L\n"
    "BO_ 386 X: 2 X\n SG_ Current : 0|16@1- (0.1,0) [0|0] \"A\" L\n";

}  // namespace

TEST_GROUP(SamplerSource) {
    ImportBench bench;
};

TEST(SamplerSource, reads_samples_with_and_without_their_numbers) {
    bench.import("1.0 2.5 \n1.0 3.5 \n", sampler_map);
    STRCMP_EQUAL("2.5 3.5", joined(bench.column("x_current_A")).c_str());
    STRCMP_EQUAL("0 0.01", joined(bench.column("time_s")).c_str());
    bench.import("overrun\n700 1.0 2.5 \n701 1.0 3.5 \n", sampler_map);
    STRCMP_EQUAL("0 0.01", joined(bench.column("time_s")).c_str());
}

TEST(SamplerSource, keeps_the_length_of_a_gap_by_the_samples_numbers) {
    std::string text;
    for (int k = 0; k < 20; ++k) {
        text += std::string(k == 10 ? "overrun\n" : "") + std::to_string(k < 10 ? k : k + 5) + " 0 1 \n";
    }
    const auto recording = bench.import(text, sampler_map);
    LONGS_EQUAL(1, recording.steps.gaps());
    DOUBLES_EQUAL(0.06, recording.steps.longest_gap_s(), 1e-9);
    DOUBLES_EQUAL(0.24, recording.steps.duration_s(), 1e-9);
}

TEST(SamplerSource, refuses_lost_samples_without_numbers) {
    CHECK(contains(bench.error("0 1 \noverrun\n0 1 \n", sampler_map), "source0:3: samples were lost"));
    STRCMP_EQUAL("", bench.error("overrun\n0 1 \n0 1 \n", sampler_map).c_str());
}

TEST(SamplerSource, leaves_out_a_last_line_without_its_end) {
    bench.import("0 1 \n0 2 \n0 3", sampler_map);
    STRCMP_EQUAL("1 2", joined(bench.column("x_current_A")).c_str());
}

TEST(SamplerSource, names_the_place_of_what_does_not_fit) {
    CHECK(contains(bench.error("0 1 \n0 1 2 \n", sampler_map), "source0:2: 3 cells; expected 2"));
    CHECK(contains(bench.error("0 1 \n0 x \n", sampler_map), "source0:2: cell 2: 'x'"));
    CHECK(contains(bench.error("0 1,5 \n", sampler_map), "source0:1: cell 2: '1,5'"));
}

TEST(SamplerSource, names_the_nearest_pin) {
    const std::string map =
        "[source]\nnames = [\"x-current\"]\n[time_s]\nrate_hz = 1\n[x_current_A]\nsource = \"x-curent\"\n";
    CHECK(contains(bench.error("1 \n", map), "map.toml: source.names: no pin 'x-curent'; the nearest is 'x-current'"));
}

TEST(SamplerSource, takes_a_pin_by_its_number_or_by_a_name_that_is_there_once) {
    const auto with_source = [](const char* source) { return with_text(sampler_map, "source = \"i\"", source); };
    bench.import("1.0 2.5 \n", with_source("source_number = 1"));
    STRCMP_EQUAL("1", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(bench.error("1.0 2.5 \n", with_source("source_number = 3")),
                   "source.names: source_number = 3; there are 2 pins"));
    CHECK(contains(bench.error("1.0 2.5 \n", with_text(sampler_map, "\"a\"", "\"i\"")),
                   "source.names: pin 'i' is there twice; expected once, or source_number"));
    CHECK(
        contains(bench.error("1.0 2.5 \n", with_text(sampler_map, "names = [\"a\", \"i\"]", "format = \"halsampler\"")),
                 "map.toml: source.names: missing, expected the names of the sampler's pins"));
}

TEST(SamplerSource, skips_blank_lines_and_comments_and_takes_no_quotes) {
    bench.import("# sampled\n\n0 1 \n \n0 2 \n  ", sampler_map);
    STRCMP_EQUAL("1 2", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(bench.error("0 \"1 \n", sampler_map), "source0:1: a quote; expected numbers as halsampler prints"));
}

TEST_GROUP(SinumerikSource) {
    ImportBench bench;
};

TEST(SinumerikSource, holds_a_signal_until_its_next_value) {
    bench.import(
        trace_of("<rec time=\"0.000\" f1=\"1\" f2=\"5\"/><rec time='0.002' f1='2'/><rec time=\"0.004\" f2=\"6\"/>"),
        trace_map);
    STRCMP_EQUAL("1 2 2", joined(bench.column("x_current_A")).c_str());
    STRCMP_EQUAL("5 5 6", joined(bench.column("x_velocity_mm_s")).c_str());
}

TEST(SinumerikSource, puts_records_in_where_nothing_had_changed_but_not_over_more_than_a_second) {
    const auto recording = bench.import(
        trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/><rec time=\"0.008\" f1=\"2\"/><rec time=\"3\" f1=\"3\"/>"),
        trace_map);
    STRCMP_EQUAL("0 0.002 0.004 0.006 0.008 3", joined(bench.column("time_s")).c_str());
    STRCMP_EQUAL("1 1 1 1 2 3", joined(bench.column("x_current_A")).c_str());
    LONGS_EQUAL(1, recording.steps.gaps());
}

TEST(SinumerikSource, knows_a_signal_by_name_id_or_description) {
    const std::string trace = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/>");
    for (const char* name : {"/Nck/vel <1>", "f2", "velocity"}) {
        bench.import(trace, std::string("[x_velocity_mm_s]\nsource = \"") + name + "\"\n");
        STRCMP_EQUAL("5", joined(bench.column("x_velocity_mm_s")).c_str());
    }
    CHECK(contains(bench.error(trace, "[x_velocity_mm_s]\nsource = \"/Nck/vel <2>\"\n"),
                   "the nearest is '/Nck/vel <1>'"));
}

TEST(SinumerikSource, takes_the_bits_of_not_a_number_for_none) {
    bench.import(trace_of("<rec time=\"0\" f1=\"9221120237041090560\" f2=\"5\"/><rec time=\"0.002\" f1=\"2\"/>"),
                 trace_map);
    STRCMP_EQUAL("- 2", joined(bench.column("x_current_A")).c_str());
}

TEST(SinumerikSource, ends_with_the_last_whole_record_of_a_file_that_is_cut_off) {
    const std::string whole = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/><rec time=\"0.002\" f1=\"2\"/>");
    const auto recording = bench.import(whole.substr(0, whole.rfind("f1=\"2") + 4), trace_map);
    STRCMP_EQUAL("1", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(recording.files[0].notes.back(), "cut off"));
}

TEST(SinumerikSource, names_the_place_of_what_does_not_fit) {
    CHECK(contains(bench.error(trace_of("<rec time=\"0\" f1=\"x\"/>"), trace_map),
                   "source0:5: f1 = 'x' in the tag <rec>"));
    CHECK(contains(bench.error(trace_of("<rec f1=\"1\"/>"), trace_map), "time = ''"));
    CHECK(contains(bench.error(trace_of("<rec time=\"0\" f1=1/>"), trace_map), "expected a value in quotes"));
    CHECK(contains(bench.error(trace_of("<rec time=\"1\"/><rec time=\"0.5\"/>"), trace_map),
                   "expected a time that grows"));
    CHECK(contains(bench.error(trace_of("<rec time=\"0\"/></dataFrame><dataFrame><dataSignal id=\"f1\"/>"), trace_map),
                   "a second <dataFrame>"));
    CHECK(contains(bench.error("<html><body>no trace</body></html>", trace_map), "no <dataFrame>"));
    CHECK(contains(bench.error("<!DOCTYPE x [<!ENTITY a \"b\">]><traceData/>", trace_map), "a document type"));
    CHECK(contains(bench.error(trace_of("<rec time=\"&bomb;\"/>"), trace_map), "&bomb; is not known"));
}

TEST(SinumerikSource, refuses_tags_that_are_no_xml_with_their_line) {
    const std::string begin = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/>");
    const auto with_record = [&](const std::string& record) {
        return bench.error(with_text(begin, "</dataFrame>", record + "</dataFrame>"), trace_map);
    };
    CHECK(contains(with_record(std::string("a\0b", 3)), "source0:5: a NUL byte; expected XML in UTF-8"));
    CHECK(contains(with_record("<rec " + std::string(70'000, 'x') + ">"), "a tag of more than 64 KiB"));
    CHECK(contains(with_record("<rec time=\"1&amp\"/>"), "'&' without ';' in an attribute"));
    for (const char* entity : {"&#;", "&#x;", "&#xG;", "&#4z;", "&#99999999999;"}) {
        CHECK_TEXT(contains(with_record(std::string("<rec time=\"") + entity + "\"/>"), "is not known"), entity);
    }
}

TEST(SinumerikSource, ends_quietly_in_a_comment_that_is_cut_off) {
    const std::string whole = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/>");
    const auto recording = bench.import(with_text(whole, "</dataFrame>", "<!-- no end"), trace_map);
    STRCMP_EQUAL("1", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(recording.files[0].notes.back(), "cut off"));
}

TEST(SinumerikSource, passes_over_character_data_and_reads_letters_by_their_number) {
    const std::string trace = trace_of("<![CDATA[ <rec time=\"9\"/> ]]><rec time=\"&#x30;\" f1=\"&#50;\" f2=\"5\"/>");
    bench.import(trace, trace_map);
    STRCMP_EQUAL("2", joined(bench.column("x_current_A")).c_str());
    for (const char* letter : {"&#0;", "&#x20AC;"}) {  // neither is a letter of a number
        CHECK(contains(bench.error(with_text(trace, "&#50;", letter), trace_map), "f1 = '?' in the tag <rec>"));
    }
}

TEST(SinumerikSource, takes_a_signal_by_its_number_and_needs_an_id_of_each) {
    const std::string trace = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/>");
    bench.import(trace, "[x_current_A]\nsource_number = 2\n");
    STRCMP_EQUAL("5", joined(bench.column("x_current_A")).c_str());
    CHECK(contains(bench.error(trace, "[x_current_A]\nsource_number = 3\n"), "source_number = 3; there are 2 signals"));
    CHECK(contains(bench.error(with_text(trace, " id=\"f2\"", ""), trace_map), "a <dataSignal> without id"));
    CHECK(contains(bench.error(with_text(trace, "f1=\"1\"", "f1=\"1,5\""), trace_map), "f1 = '1,5' in the tag <rec>"));
    std::string signals;
    for (int k = 0; k < 1000; ++k) {
        signals += "<dataSignal id=\"s" + std::to_string(k) + "\"/>";
    }
    CHECK(contains(bench.error(with_text(trace, "<rec", signals + "<rec"), trace_map), "more than 1000 signals"));
}

TEST(SinumerikSource, without_an_interval_puts_no_record_in) {
    std::string trace = trace_of("<rec time=\"0\" f1=\"1\" f2=\"5\"/><rec time=\"0.008\" f1=\"2\"/>");
    trace = with_text(with_text(trace, "interval=\"0.002\"", ""), "interval=\"0.004\"", "");
    bench.import(trace, trace_map);
    STRCMP_EQUAL("1 2", joined(bench.column("x_current_A")).c_str());
}

TEST(SinumerikSource, refuses_a_signal_among_the_records) {
    CHECK(contains(bench.error(trace_of("<rec time=\"0\" f1=\"1\"/><dataSignal id=\"f3\"/>"), trace_map),
                   "a second <dataFrame>"));
}

TEST(SinumerikSource, has_its_own_time_and_no_other) {
    CHECK(contains(bench.error(trace_of("<rec time=\"0\"/>"), trace_map + "[time_s]\nrate_hz = 500\n"),
                   "has a time of its own, expected no [time_s]"));
}

TEST_GROUP(CandumpSource) {
    ImportBench bench;
    void setup() override {
        bench.write("bus.dbc", bus_dbc);
    }
};

TEST(CandumpSource, needs_a_rate_where_signals_come_at_different_times) {
    const std::string log = "(1436509052.249713) can0 181#0A00\n(1436509052.250213) can0 182#1400\n";
    CHECK(contains(bench.error(log, bus_map), "in several messages, at different times; expected --rate HZ"));
    bench.import(log, bus_map, {2000.0, 0.02});
    STRCMP_EQUAL("0 0.0005", joined(bench.column("time_s")).c_str());
    STRCMP_EQUAL("1 1", joined(bench.column("spindle_current_A")).c_str());
    STRCMP_EQUAL("- 2", joined(bench.column("x_current_A")).c_str());
}

TEST(CandumpSource, holds_a_value_no_longer_than_stated) {
    std::string log = "(10.000000) can0 182#1400\n";
    for (int k = 0; k < 10; ++k) {
        log += "(10.00" + std::to_string(k) + "000) can0 181#0A00\n";
    }
    bench.import(log, bus_map, {1000.0, 0.003});
    STRCMP_EQUAL("2 2 2 2 - - - - - -", joined(bench.column("x_current_A")).c_str());
    STRCMP_EQUAL("1 1 1 1 1 1 1 1 1 1", joined(bench.column("spindle_current_A")).c_str());
}

TEST(CandumpSource, leaves_out_rows_without_any_value_however_long_the_pause_is) {
    const std::string log = "(10.0) can0 181#0A00\n(900000010.0) can0 181#1400\n";
    const auto recording = bench.import(log, bus_map, {1000.0, 0.003});
    LONGS_EQUAL(5, recording.steps.rows());
    STRCMP_EQUAL("1 1 1 1 2", joined(bench.column("spindle_current_A")).c_str());
}

TEST(CandumpSource, takes_a_row_from_each_frame_where_one_message_has_all) {
    const std::string map = "[source]\ndbc = \"bus.dbc\"\n[x_current_A]\nsource = \"X.Current\"\n";
    bench.import("# log\n(1.000) can0 182#1400 R\n(1.001) can0 123##0AA\n(1.002) can0 182#FFFF\n", map);
    STRCMP_EQUAL("2 -0.1", joined(bench.column("x_current_A")).c_str());
    STRCMP_EQUAL("0 0.002", joined(bench.column("time_s")).c_str());
}

TEST(CandumpSource, names_the_place_of_what_does_not_fit) {
    const Resampling rate{1000.0, 0.02};
    CHECK(contains(bench.error("(1.0) can0 181#0A00\n(1.1) can0 18#0A00\n", bus_map, rate), "source0:2:14: "));
    CHECK(contains(bench.error("(1.0) can0 181#0A00\n(1.1) can1 181#0A00\n", bus_map, rate),
                   "source0:2: frames of can0 and can1; expected source.interface"));
    CHECK(contains(bench.error("(1.0) can0 181#0A00\n(0.5) can0 181#0A00\n", bus_map, rate),
                   "expected a time that grows"));
    CHECK(contains(bench.error("(1.0) can0 222#0A00\n", bus_map, rate), "no rows"));
    CHECK(contains(bench.error("(1.0) can0 181#0A00\n", with_text(bus_map, "X.Current", "X.Curent"), rate),
                   "map.toml: no signal 'X.Curent'"));
}

TEST(CandumpSource, reads_one_interface_of_several) {
    const std::string map = with_text(bus_map, "[source]\n", "[source]\ninterface = \"can1\"\n");
    bench.import("(1.0) can0 181#0A00\n(1.0) can1 181#1400\n", map, {1000.0, 0.02});
    STRCMP_EQUAL("2", joined(bench.column("spindle_current_A")).c_str());
}

TEST(CandumpSource, needs_the_dbc_file_and_signals_by_name) {
    const std::string log = "(1.0) can0 181#0A00\n";
    CHECK(contains(bench.error(log, with_text(bus_map, "dbc = \"bus.dbc\"\n", "")),
                   "map.toml: source.dbc: missing, expected the name of a DBC file"));
    CHECK(contains(bench.error(log, with_text(bus_map, "source = \"X.Current\"", "source_number = 2")),
                   "source_number = 2: a candump log has no columns, expected source = \"MESSAGE.SIGNAL\""));
}

TEST(CandumpSource, takes_no_value_from_a_remote_frame) {
    const std::string map = "[source]\ndbc = \"bus.dbc\"\n[x_current_A]\nsource = \"X.Current\"\n";
    bench.import("(1.000) can0 182#R\n(1.001) can0 182#1400\n", map);
    STRCMP_EQUAL("2", joined(bench.column("x_current_A")).c_str());
}
