// SPDX-License-Identifier: Apache-2.0
#include "bridge.hpp"
#include "inputs.hpp"
#include "on_terminal.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

/// `millforce serve --view` on a terminal, with a CNC's bridge at its socket.

namespace {

const std::string enter = "\x1b[?1049h";
const std::string leave = "\x1b[?1049l";

/// Of the next drawing.
std::size_t longest_line(OnTerminal& terminal) {
    terminal.forget();
    const std::string drawing = terminal.between("\x1b[1;1H", "\x1b[J");
    CHECK(!drawing.empty());
    std::size_t longest = 0;
    for (std::size_t place = 0; place < drawing.size();) {
        const std::size_t end = drawing.find("\x1b[K", place);
        longest = std::max(longest, end - place);
        const std::size_t next = drawing.find('H', end);
        place = next != std::string::npos ? next + 1 : drawing.size();
    }
    return longest;
}

}  // namespace

TEST_GROUP(ViewOnTerminal) {
    Inputs inputs;
    std::unique_ptr<OnTerminal> serve;
    std::unique_ptr<Bridge> cnc;

    [[nodiscard]] std::vector<std::string> words() const {
        return {"serve",  inputs.name("a.sock"),    "--machine", inputs.name("machine.toml"),
                "--tool", inputs.name("tool.toml"), "--view"};
    }
    void start() {
        serve = std::make_unique<OnTerminal>(words(), 80, 24);
        cnc = std::make_unique<Bridge>(inputs.name("a.sock"));
        cnc->sample.spindle_current_A = 1.4F;
        cnc->sample.axis_current_A[0] = 2.3F;
        cnc->sample.axis_velocity_mm_s[0] = 20.0F;
        for (int k = 0; k < 300; ++k) {
            cnc->ask();
        }
        CHECK(serve->shows("in air"));
    }
};

TEST(ViewOnTerminal, shows_state_override_and_events_and_gives_the_terminal_back_at_ctrl_c) {
    start();
    for (const char* part : {"state", "limit", "override", "immersion", "depth", "no estimate", "operator 75 %",
                             "conditions none", "run begins"}) {
        CHECK_TEXT(serve->shows(part), part);
    }
    CHECK(longest_line(*serve) <= 80);
    serve->press("\x03");
    LONGS_EQUAL(0, serve->end());
    const std::size_t left = serve->text().find(leave);
    CHECK(left != std::string::npos);
    CHECK(serve->text().find(enter, left) == std::string::npos);
    CHECK(serve->text().find("millforce: disconnected after 300 samples", left) != std::string::npos);
}

TEST(ViewOnTerminal, shows_a_fault_in_words_within_the_width_of_a_terminal_that_became_small) {
    start();
    serve->resize(40, 12);
    serve->forget();
    cnc->ask(200'000);
    CHECK(serve->shows("fault: held until reset"));
    CHECK(longest_line(*serve) <= 40);
    serve->interrupt(SIGTERM);
    LONGS_EQUAL(0, serve->end());
}

TEST(ViewOnTerminal, leaves_the_shell_its_screen_while_it_is_stopped) {
    start();
    serve->forget();
    serve->interrupt(SIGTSTP);
    CHECK(serve->is_stopped());
    CHECK(serve->shows(leave));
    serve->forget();
    serve->interrupt(SIGCONT);
    CHECK(serve->shows(enter));
    serve->interrupt(SIGINT);
    LONGS_EQUAL(0, serve->end());
}

TEST(ViewOnTerminal, is_refused_where_standard_output_is_none) {
    const Ended ended = run_millforce(words());
    LONGS_EQUAL(2, ended.exit_code);
    CHECK(ended.error.find("--view: standard output is no terminal") != std::string::npos);
}

TEST(ViewOnTerminal, plays_a_recording_at_its_speed_and_gives_the_terminal_back_at_its_end) {
    const Ended simulated =
        run_millforce({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("out")});
    LONGS_EQUAL(0, simulated.exit_code);
    OnTerminal replay({"replay", inputs.name("out/recording.csv"), "--machine", inputs.name("machine.toml"), "--tool",
                       inputs.name("tool.toml"), "--view", "--speed", "4"},
                      80, 24);
    CHECK(replay.shows("recording.csv"));
    CHECK(replay.shows("in the cut"));
    LONGS_EQUAL(0, replay.end());
    const std::size_t left = replay.text().find(leave);
    CHECK(left != std::string::npos);
    CHECK_TEXT(replay.text().find("time_s,", left) == std::string::npos, "rows are on the terminal");
}

TEST(ViewOnTerminal, a_recording_that_is_stopped_leaves_no_file_and_ends_by_the_signal) {
    const Ended simulated =
        run_millforce({"simulate", inputs.name("scenario.toml"), "--record", "--out", inputs.name("out")});
    LONGS_EQUAL(0, simulated.exit_code);
    OnTerminal replay({"replay", inputs.name("out/recording.csv"), "--machine", inputs.name("machine.toml"), "--tool",
                       inputs.name("tool.toml"), "--view", "--speed", "0.01", "-o", inputs.name("rows.csv")},
                      80, 24);
    CHECK(replay.shows("recording.csv"));
    replay.press("\x03");
    LONGS_EQUAL(-1, replay.end());
    CHECK(!std::filesystem::exists(inputs.name("rows.csv")));
    CHECK(replay.text().find(leave) != std::string::npos);
}
