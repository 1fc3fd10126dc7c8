// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"

#include <algorithm>
#include <array>
#include <memory>

#include "part_map/part_map_file.hpp"
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

const std::string stock = R"([stock]
min_x_mm = 0
min_y_mm = -12
max_x_mm = 120
max_y_mm = 12
top_mm = 0
cell_mm = 0.1
start_x_mm = -40
start_y_mm = 0
start_z_mm = -3
)";

/// Two slots in a block, the second one after a rest in which the tool is changed.
const std::string two_slots = R"(G21 G90 G94
S4000 M3
G0 X-8 Z-5
G1 X14 F1500
G0 Z5
G0 X-20 Y25
G4 P0.5
G0 X-8 Z-5
G1 X14
G0 Z5
M5
M30
)";
constexpr std::size_t line_of_first_slot = 4;
constexpr std::size_t line_of_second_slot = 9;

/// Tool 12 widens the slot of tool 7 by 6 mm: in steel alone it would meet a full slot.
const std::string widened_slot = R"(G21 G90 G94
T7 M6
S4000 M3
G0 X-8 Z-5
G1 X14 F1500
G0 Z5
G0 X-20 Y6
T12 M6
G4 P0.5
G0 X-8 Z-5
G1 X14
G0 Z5
M5
M30
)";
constexpr std::size_t line_of_widening = 11;

const std::string wide_stock = R"([stock]
min_x_mm = 0
min_y_mm = -12
max_x_mm = 40
max_y_mm = 37
top_mm = 0
cell_mm = 0.1
start_x_mm = -20
start_y_mm = 0
start_z_mm = 10
)";

/// The tools 7 and 12 in the folder `tools`; there is no 99.
class ToolsFolder : public LiveFolder {
  public:
    ToolsFolder() {
        write("scenario.toml", part_scenario + stock);
        write("part.ngc", part);
        std::filesystem::create_directories(file("tools"));
        write("tools/T7.toml", text("tool.toml"));
        write("tools/T12.toml", text("tool.toml"));
    }
    [[nodiscard]] Words run_words() const {
        return with_tools({"run", "vcan0", "--log", file("run.jsonl"), "--record", file("run.log")});
    }
    [[nodiscard]] Words replay_words() const {
        return with_tools({"replay", file("run.log"), "-o", file("replay.csv"), "--verify", file("run.jsonl")});
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
    [[nodiscard]] Words with_tools(const Words& words) const {
        return with(words, {"--machine", file("machine.toml"), "--tools", file("tools")});
    }
};

/// The CNC's frame with the number of the tool, from now on: every 10 ms, or a slow machine would do nothing but take
/// these frames. The bus may run faster than time: the controllers here are patient.
class ToolTeller {
  public:
    void tell(std::uint32_t number) {
        std::string hex;
        for (const std::uint8_t byte : program_status::encode_tool(number, 0x2FD).data) {
            std::array<char, 3> digits{};
            std::snprintf(digits.data(), digits.size(), "%02X", static_cast<unsigned>(byte));
            hex += digits.data();
        }
        const long before = frames_on_the_bus();
        sender_ = std::make_unique<Child>("cangen vcan0 -g 10 -I 2FD -L 8 -D " + hex);
        CHECK(wait_until([&] { return frames_on_the_bus() > before; }));  // a bus in lock-step does not wait for it
    }
    void tell_none() { sender_.reset(); }

  private:
    static long frames_on_the_bus() { return std::stol(test::text_of("/sys/class/net/vcan0/statistics/tx_packets")); }

    std::unique_ptr<Child> sender_;
};

void replays(const ToolsFolder& folder, const Words& more = {}) {
    const test::Ended replay = test::run_millforce(with(with(folder.replay_words(), more), {"--lock-step"}));
    STRCMP_CONTAINS("bit for bit", replay.out.c_str());
    LONGS_EQUAL(0, replay.exit_code);
}

}  // namespace

TEST_GROUP(RunWithTools) {
    ToolsFolder folder;
    ToolTeller cnc;

    [[nodiscard]] bool is_in_cut() const {
        return wait_until([&] { return folder.estimates_with("\"state\":\"in_cut\"").size() > 5; });
    }
    /// The whole cut by the limits of tool 7; the operator's override is 1.
    void judge_cut() const {
        for (const std::string& line : folder.estimates_with("\"state\":\"in_cut\"")) {
            STRCMP_EQUAL("7", member(line, "tool").c_str());
            CHECK(std::stod(member(line, "override")) < 0.9);
        }
    }
};

TEST(RunWithTools, the_tool_frame_changes_the_tool_at_rest_and_none_in_a_cut) {
    cnc.tell(7);
    LockStep run(folder.run_words(), folder);
    CHECK(is_in_cut());
    cnc.tell(12);
    CHECK(folder.logged("\"tool_change_due\""));
    CHECK(wait_until([&] { return folder.has_tool("12"); }));
    cnc.tell(99);
    CHECK(folder.logged("\"tool_unknown\""));
    CHECK(wait_until([&] { return folder.has_tool("0"); }));
    cnc.tell(7);
    CHECK(wait_until([&] { return folder.has_tool("7"); }));
    run.stop();
    LONGS_EQUAL(0, run.controller().exit_code());
    judge_cut();
    for (const std::string& line : folder.estimates_with("\"tool\":0,")) {
        STRCMP_EQUAL("1", member(line, "override").c_str());
        STRCMP_EQUAL("", member(line, "tangential_force_N").c_str());
    }
    STRCMP_CONTAINS("vcan0: tool_change_due\n", run.controller().error().c_str());
    STRCMP_CONTAINS("vcan0: tool_unknown", run.controller().error().c_str());
    replays(folder);
}

TEST(RunWithTools, a_cnc_that_stops_telling_the_tool_in_a_cut_keeps_its_limits_to_the_next_rest) {
    cnc.tell(7);
    LockStep run(folder.run_words(), folder);
    CHECK(is_in_cut());
    cnc.tell_none();
    CHECK(folder.logged("\"tool_change_due\""));
    CHECK(wait_until([&] { return folder.has_tool("0"); }));
    run.stop();
    LONGS_EQUAL(0, run.controller().exit_code());
    judge_cut();
    replays(folder);
}

/// At 1 kHz, patient with the CNC.
TEST_GROUP(RunWithMapsOfTools) {
    ToolsFolder folder;
    ToolTeller cnc;
    const Words with_program{"--program", folder.file("part.ngc")};

    void setup() override {
        folder.write("machine.toml",
                     test::with(test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml"),
                                "sync_period_ms = 1.0", "sync_period_ms = 1.0\nprogram_status_timeout_ms = 2000"));
        folder.write("part.ngc", two_slots);
        folder.write("scenario.toml", part_scenario + wide_stock);
        folder.write("stock.toml", wide_stock);
    }

    /// Of the whole part, as if it were milled with that tool.
    std::string preview(const std::string& tool) const {
        const std::string map = folder.file(tool + ".map");
        const test::Ended ended =
            test::run_millforce({"preview", folder.file("part.ngc"), "--stock", folder.file("stock.toml"), "--tool",
                                 folder.file("tools/" + tool + ".toml"), "-o", map});
        LONGS_EQUAL(0, ended.exit_code);
        return map;
    }

    /// The first slot with tool 7, the second with tool 12. What the controller says.
    std::string mill(const Words& more) {
        folder.write("run.jsonl", "");
        cnc.tell(7);
        LockStep run(with(with(folder.run_words(), with_program), more), folder);
        CHECK(wait_until([&] { return folder.estimates_with("\"state\":\"in_cut\"").size() > 5; }));
        cnc.tell(12);
        run.mill();
        STRCMP_EQUAL("", run.plant().error().c_str());
        LONGS_EQUAL(0, run.plant().exit_code());  // the bounds hold, the program finished
        LONGS_EQUAL(0, run.controller().exit_code());
        return run.controller().error();
    }
    [[nodiscard]] double time_s() const {
        return std::stod(member(folder.text("out/summary.json"), "time_s"));
    }
    /// In the middle of the line's block.
    [[nodiscard]] static double immersion_in(const host::PartMap& map, std::size_t line) {
        const auto of_line = [line](const host::MapPlace& place) { return place.line == line; };
        const auto begin = std::ranges::find_if(map, of_line);
        const auto middle = begin + std::ranges::count_if(map, of_line) / 2;
        return immersion_of(*middle);
    }
    [[nodiscard]] bool cuts_in(const std::string& map, std::size_t line) const {
        const host::PartMap places = host::read_part_map(folder.file(map)).map;
        return std::ranges::any_of(
            places, [line](const host::MapPlace& place) { return place.line == line && !place.cut.empty(); });
    }
};

TEST(RunWithMapsOfTools, each_tool_looks_ahead_in_its_own_map_and_leaves_its_own_behind) {
    mill({"--learn", folder.file("seen")});
    const double blind_s = time_s();
    CHECK(cuts_in("seen/T7.map", line_of_first_slot) && cuts_in("seen/T12.map", line_of_second_slot));
    CHECK_FALSE(cuts_in("seen/T7.map", line_of_second_slot) || cuts_in("seen/T12.map", line_of_first_slot));

    const Words both{"--map", preview("T7"), "--map", preview("T12")};
    const std::string says = mill(both);
    CHECK(has(says, "T7.map: looks ahead in part.ngc, ") && has(says, ", with T12\n"));
    CHECK_COMPARE(time_s(), <, 0.85 * blind_s);
    replays(folder, with(with_program, both));

    mill({"--map", folder.file("seen/T7.map"), "--map", folder.file("seen/T12.map")});
    CHECK_COMPARE(time_s(), <, 0.92 * blind_s);
}

TEST(RunWithMapsOfTools, those_of_preview_hold_what_the_tool_before_has_left) {
    const std::string plant_program = test::with(test::with(widened_slot, "T7 M6", "(T7)"), "T12 M6", "(T12)");
    folder.write("part.ngc", widened_slot);
    folder.write("plant.ngc", plant_program);  // the plant has one tool, which goes by both numbers
    folder.write("scenario.toml", test::with(part_scenario, "part.ngc", "plant.ngc") + wide_stock);
    mill({"--learn", folder.file("seen")});
    const double blind_s = time_s();

    const test::Ended preview =
        test::run_millforce({"preview", folder.file("part.ngc"), "--stock", folder.file("stock.toml"), "--tools",
                             folder.file("tools"), "-o", folder.file("drawn")});
    STRCMP_EQUAL("", preview.error.c_str());
    const host::PartMap widening = host::read_part_map(folder.file("drawn/T12.map")).map;
    DOUBLES_EQUAL(6.0 / 5.0, immersion_in(widening, line_of_widening), 0.05);

    const std::string says = mill({"--map", folder.file("drawn/T7.map"), "--map", folder.file("drawn/T12.map")});
    CHECK(has(says, "T7.map: looks ahead in part.ngc, ") && has(says, "T12.map: looks ahead in part.ngc, "));
    CHECK_FALSE(has(folder.text("run.jsonl"), "map_refuted"));
    CHECK_COMPARE(time_s(), <, 0.85 * blind_s);

    for (const std::string tool : {"T7", "T12"}) {
        const test::Ended join = test::run_millforce(
            {"map", "join", folder.file("drawn/" + tool + ".map"), folder.file("seen/" + tool + ".map"), "--tool",
             folder.file("tools/" + tool + ".toml"), "-o", folder.file(tool + ".joined")});
        STRCMP_EQUAL("", join.error.c_str());
        LONGS_EQUAL(0, join.exit_code);
    }
}
