// SPDX-License-Identifier: Apache-2.0
#include "live/view_text.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "control/cut_state.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

Telemetry in_cut() {
    Telemetry telemetry;
    firmware::TickRecord& tick = telemetry.sample.tick;
    tick.feed_override = {0.74F, false, static_cast<std::uint8_t>(control::CutState::in_cut), 0, 42};
    tick.limit = static_cast<std::uint8_t>(control::Limit::force);
    tick.radial_immersion = 0.62F;
    tick.radial_immersion_sd = 0.05F;
    tick.axial_depth_mm = 3.1F;
    tick.axial_depth_sd_mm = 0.1F;
    telemetry.sample.is_held = false;
    telemetry.shown = {612.0F, 700.0F};
    return telemetry;
}

/// Characters of UTF-8.
std::size_t length(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U; }));
}

}  // namespace

TEST_GROUP(ViewText) {
    ViewState state{.title = "can0"};
    ViewSize size{};

    std::string text() {
        std::string all;
        for (const std::string& line : view_lines(state, size)) {
            all += line + "\n";
        }
        return all;
    }
    void shows(const std::string& part) {
        const std::string all = text();
        CHECK_TEXT(all.find(part) != std::string::npos, (part + " in\n" + all).c_str());
    }
};

TEST(ViewText, has_the_load_against_its_threshold_and_estimates_with_their_95_percent) {
    state.take(in_cut());
    shows("612 N of 700 N, 87 %");
    shows("74 %");
    shows("0.62 ± 0.10 (95 %)");
    shows("3.1 ± 0.2 mm (95 %)");
    shows("in the cut");
    shows("limit      force");
}

TEST(ViewText, says_so_where_there_is_no_estimate_no_sample_or_no_newer_one) {
    shows("waiting for samples");
    state.take(Telemetry{});
    shows("load       no estimate");
    shows("depth      no estimate");
    shows("override   0 %, HOLD");
    state.age_s = 3.2;
    shows("no tick for 3 s");
}

TEST(ViewText, fits_any_terminal) {
    state.take(in_cut());
    for (int k = 0; k < 200; ++k) {
        state.add_event(2'000'000U * static_cast<std::uint64_t>(k), std::string(300, 'x'));
    }
    for (const ViewSize tried : {ViewSize{80, 24, true}, ViewSize{20, 5, true}, ViewSize{1, 1, false},
                                 ViewSize{300, 100, true}, ViewSize{80, 24, false}}) {
        const auto lines = view_lines(state, tried);
        CHECK(lines.size() <= tried.rows);
        for (const std::string& line : lines) {
            CHECK_TEXT(length(line) <= tried.columns, line.c_str());
        }
    }
}

TEST(ViewText, draws_the_threshold_and_the_uncertain_part_of_a_bar) {
    size = {78, 24, false};  // a bar of 40 columns
    state.take(in_cut());
    shows(std::string(28, '#') + "...." + "|" + ".......");
    shows("0.62 +- 0.10 (95 %)");
    state.newest->shown.peak_N = 100'000.0F;
    shows(std::string(32, '#') + "|#######");
}

TEST(ViewText, obeys_no_control_character_of_a_name_or_a_message) {
    state.title =
        "\x1b[2Jcan\x9b"
        "0\xc2\x9b";
    state.add_event(0, "lost \x1b]0;title\x07");
    const std::string all = text();
    CHECK(std::none_of(all.begin(), all.end(), [](char letter) {
        const auto code = static_cast<unsigned char>(letter);
        return letter != '\n' && (code < 0x20 || (code >= 0x7F && code < 0xA0));
    }));
}

TEST(ViewText, shows_what_two_sources_say_at_once_one_time) {
    state.add_event(1'000'000, "fault: overload");
    state.add_event(1'100'000, "millforce: fault: overload");
    LONGS_EQUAL(1, state.events.size());
    state.add_event(3'000'000, "fault: overload");
    LONGS_EQUAL(2, state.events.size());
}

TEST(ViewText, says_where_in_the_program_the_tool_is_and_what_holds_it) {
    Telemetry telemetry = in_cut();
    state.take(telemetry);
    shows("program    F not known, operator 100 %\n");
    telemetry.sample.program.programmed_feed_mm_s = 20.0F;
    telemetry.sample.program.line = 37;
    telemetry.sample.program.rapid = true;
    telemetry.sample.program.feed_hold = true;
    telemetry.sample.tool = 7;
    state.take(telemetry);
    shows("F 1200 mm/min, operator 100 %, line 37, tool 7, rapid, feed hold");
}

TEST(ViewText, names_conditions_a_fault_and_ticks_that_it_did_not_show) {
    Telemetry telemetry = in_cut();
    state.take(telemetry);
    shows("conditions none");
    telemetry.sample.conditions.set(static_cast<firmware::Condition>(0), true);
    telemetry.sample.conditions.set(static_cast<firmware::Condition>(1), true);
    telemetry.sample.tick.feed_override.fault = static_cast<std::uint8_t>(control::Fault::overload);
    telemetry.lost = 12;
    state.take(telemetry);
    const std::string all = text();
    const std::size_t begin = all.find("conditions ");
    CHECK_TEXT(all.substr(begin, all.find('\n', begin) - begin).find(", ") != std::string::npos, all.c_str());
    shows("(overload)");
    shows("12 ticks were not shown: this view was too slow");
}

TEST(ViewText, gives_no_load_without_a_limit_and_an_override_above_the_programmed_feed_its_own_scale) {
    Telemetry telemetry = in_cut();
    for (const float none : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
        telemetry.shown.limit_N = none;
        state.take(telemetry);
        shows("load       no estimate");
    }
    size = {78, 24, false};  // a bar of 40 columns
    telemetry.sample.tick.feed_override.ratio = 1.5F;
    state.take(telemetry);
    shows("150 %");
    shows(std::string(30, '#') + "..........");
}

TEST(ViewText, shows_an_estimate_without_a_deviation_as_certain_and_no_third_line_of_one_event) {
    Telemetry telemetry = in_cut();
    telemetry.sample.tick.axial_depth_sd_mm = std::numeric_limits<float>::quiet_NaN();
    state.take(telemetry);
    shows("3.1 ± 0.0 mm (95 %)");
    state.add_event(1'000'000, "millforce: fault: overload");
    state.add_event(1'100'000, "fault: overload");
    LONGS_EQUAL(1, state.events.size());
    state.add_event(1'200'000, "fault: spindle stall");
    LONGS_EQUAL(2, state.events.size());
}
