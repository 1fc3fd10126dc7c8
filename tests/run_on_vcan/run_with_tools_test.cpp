// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"

#include <array>
#include <memory>

#include "program_status/tool_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;

namespace {

/// A slot of 3 × 10 mm, 9 s long, between rests; the last one is longer than any test.
const std::string part = R"(G21 G90 G94
S2000 M3
G4 P1
G0 X-8
G1 X105 F1500
G0 Z20
G4 P30
G0 X-40
G4 P600
M5
M30
)";

const std::string scenario = R"(machine = "machine.toml"
tool = "tool.toml"
program = "part.ngc"
seed = 5
[stock]
min_x_mm = 0
min_y_mm = -12
max_x_mm = 120
max_y_mm = 12
top_mm = 0
cell_mm = 0.1
start_x_mm = -40
start_y_mm = 0
start_z_mm = -3
[material]
K_tc_N_mm2 = 1650
K_rc_N_mm2 = 620
K_te_N_mm = 22
K_re_N_mm = 28
)";

/// The tools 7 and 12 in the folder `tools`; there is no 99.
class ToolsFolder : public LiveFolder {
  public:
    ToolsFolder() {
        write("scenario.toml", scenario);
        write("part.ngc", part);
        std::filesystem::create_directories(file("tools"));
        write("tools/T7.toml", text("tool.toml"));
        write("tools/T12.toml", text("tool.toml"));
    }
    [[nodiscard]] std::vector<std::string> run_words() const {
        return with_tools({"run", "vcan0", "--log", file("run.jsonl"), "--record", file("run.log")});
    }
    [[nodiscard]] std::vector<std::string> replay_words() const {
        return with_tools({"replay", file("run.log"), "-o", file("replay.csv"), "--verify", file("run.jsonl")});
    }
    [[nodiscard]] std::vector<std::string> plant_words() const {
        std::vector<std::string> words = LiveFolder::plant_words();
        words.emplace_back("--lock-step");
        return words;
    }
    [[nodiscard]] std::vector<std::string> estimates_with(const std::string& member) const {
        std::vector<std::string> found;
        for (const std::string& line : lines_of(file("run.jsonl"))) {
            if (line.find("\"type\":\"estimate\"") != std::string::npos && line.find(member) != std::string::npos) {
                found.push_back(line);
            }
        }
        return found;
    }
    /// The newest estimate is by this tool.
    [[nodiscard]] bool has_tool(const std::string& number) const {
        const std::vector<std::string> estimates = estimates_with("");
        return !estimates.empty() && member(estimates.back(), "tool") == number;
    }

  private:
    [[nodiscard]] std::vector<std::string> with_tools(std::vector<std::string> words) const {
        words.insert(words.end(), {"--machine", file("machine.toml"), "--tools", file("tools"), "--lock-step"});
        return words;
    }
};

/// The CNC's frame with the number of the tool, from now on: every 2 ms, as the bus may run faster than time.
class ToolTeller {
  public:
    void tell(std::uint32_t number) {
        std::string hex;
        for (const std::uint8_t byte : program_status::encode_tool(number, 0x2FD).data) {
            std::array<char, 3> digits{};
            std::snprintf(digits.data(), digits.size(), "%02X", static_cast<unsigned>(byte));
            hex += digits.data();
        }
        sender_ = std::make_unique<Child>("cangen vcan0 -g 2 -I 2FD -L 8 -D " + hex);
    }
    void tell_none() { sender_.reset(); }

  private:
    std::unique_ptr<Child> sender_;
};

}  // namespace

TEST_GROUP(RunWithTools) {
    ToolsFolder folder;
    ToolTeller cnc;

    [[nodiscard]] bool is_in_cut() const {
        return wait_until([&] { return folder.estimates_with("\"state\":\"in_cut\"").size() > 5; });
    }
    static void end(test::Program & controller, test::Program & plant) {
        controller.interrupt(SIGTERM);
        controller.wait();
        plant.interrupt(SIGTERM);
        plant.wait();
        LONGS_EQUAL(0, controller.exit_code());
    }
    /// The whole cut by the limits of tool 7; the operator's override is 1.
    void judge_cut() const {
        for (const std::string& line : folder.estimates_with("\"state\":\"in_cut\"")) {
            STRCMP_EQUAL("7", member(line, "tool").c_str());
            CHECK(std::stod(member(line, "override")) < 0.9);
        }
    }
    void replays() const {
        const test::Ended replay = test::run_millforce(folder.replay_words());
        STRCMP_CONTAINS("bit for bit", replay.out.c_str());
        LONGS_EQUAL(0, replay.exit_code);
    }
};

TEST(RunWithTools, the_tool_frame_changes_the_tool_at_rest_and_none_in_a_cut) {
    cnc.tell(7);
    test::Program controller(folder.run_words());
    test::Program plant(folder.plant_words());
    CHECK(is_in_cut());
    cnc.tell(12);
    CHECK(folder.logged("\"tool_change_due\""));
    CHECK(wait_until([&] { return folder.has_tool("12"); }));
    cnc.tell(99);
    CHECK(folder.logged("\"tool_unknown\""));
    CHECK(wait_until([&] { return folder.has_tool("0"); }));
    cnc.tell(7);
    CHECK(wait_until([&] { return folder.has_tool("7"); }));
    end(controller, plant);
    judge_cut();
    for (const std::string& line : folder.estimates_with("\"tool\":0,")) {
        STRCMP_EQUAL("1", member(line, "override").c_str());
        STRCMP_EQUAL("", member(line, "tangential_force_N").c_str());
    }
    STRCMP_CONTAINS("vcan0: tool_change_due\n", controller.error().c_str());
    STRCMP_CONTAINS("vcan0: tool_unknown", controller.error().c_str());
    replays();
}

TEST(RunWithTools, a_cnc_that_stops_telling_the_tool_in_a_cut_keeps_its_limits_to_the_next_rest) {
    cnc.tell(7);
    test::Program controller(folder.run_words());
    test::Program plant(folder.plant_words());
    CHECK(is_in_cut());
    cnc.tell_none();
    CHECK(folder.logged("\"tool_change_due\""));
    CHECK(wait_until([&] { return folder.has_tool("0"); }));
    end(controller, plant);
    judge_cut();
    replays();
}
