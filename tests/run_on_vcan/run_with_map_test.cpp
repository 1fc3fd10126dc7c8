// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;

namespace {

/// A slot 5 mm deep from the block's side, then out of the block to the other side.
const std::string part = R"(G21 G90 G94
S4000 M3
G0 Z5
G0 X-8 Y0
G0 Z-5
G1 X26 F1500
G1 Y-18
G0 Z5
M5
M30
)";

std::string stock_from(int min_x_mm) {
    return fmt::format(R"([stock]
min_x_mm = {}
min_y_mm = -12
max_x_mm = 40
max_y_mm = 12
top_mm = 0
cell_mm = 0.1
start_x_mm = -20
start_y_mm = -10
start_z_mm = 10
)",
                       min_x_mm);
}

struct Milled {
    double time_s = 0.0;
    double peak_over_limit = 0.0;
    std::string says{};  ///< the controller
};

/// The machine of the scenarios at 1 kHz.
class MapFolder : public LiveFolder {
  public:
    MapFolder() {
        write("machine.toml", test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml"));
        write("part.ngc", part);
        write("scenario.toml", part_scenario + stock_from(0));
    }

    /// What `millforce preview` makes of a block that begins there.
    void preview(const std::string& map, int min_x_mm) const {
        write("stock.toml", stock_from(min_x_mm));
        const test::Ended ended = test::run_millforce(
            {"preview", file("part.ngc"), "--stock", file("stock.toml"), "--tool", file("tool.toml"), "-o", file(map)});
        STRCMP_EQUAL("", ended.error.c_str());
    }

    /// Without a map.
    [[nodiscard]] double time_in_process_s() const {
        LONGS_EQUAL(0, test::run_millforce({"simulate", file("scenario.toml"), "--out", file("out")}).exit_code);
        return std::stod(member(text("out/summary.json"), "time_s"));
    }
    [[nodiscard]] Milled mill(const Words& more) const {
        LockStep run(with(with(run_words(), more), {"--report", file("page")}), *this);
        run.mill();
        STRCMP_EQUAL_TEXT("", run.plant().error().c_str(), run.controller().error().c_str());
        LONGS_EQUAL(0, run.plant().exit_code());  // the bounds hold, the program finished
        LONGS_EQUAL(0, run.controller().exit_code());
        const std::string summary = text("out/summary.json");
        return {std::stod(member(summary, "time_s")), std::stod(member(summary, "peak_over_limit")),
                run.controller().error()};
    }
};

}  // namespace

TEST_GROUP(RunWithMap) {
    const MapFolder folder;
    const Words with_program{"--program", folder.file("part.ngc")};

    [[nodiscard]] Words with_map(const std::string& map, const Words& more = {}) const {
        return with(with(with_program, {"--map", folder.file(map)}), more);
    }

    void refuses(const std::string& map, const std::string& why) {
        const test::Ended ended = test::run_millforce(with(folder.run_words(), with_map(map)));
        LONGS_EQUAL(2, ended.exit_code);
        STRCMP_CONTAINS(why.c_str(), ended.error.c_str());
        STRCMP_EQUAL("", ended.out.c_str());
    }
};

TEST(RunWithMap, a_part_takes_a_fifth_less_time_with_its_map_below_the_limit_and_what_was_seen_serves_the_next_part) {
    const double blind_s = folder.time_in_process_s();
    folder.preview("part.map", 0);
    const Milled ahead = folder.mill(with_map("part.map", {"--learn", folder.file("seen.map")}));
    CHECK(has(ahead.says, "part.map: looks ahead in part.ngc, "));
    CHECK(has(ahead.says, "seen.map: "));
    CHECK_COMPARE(ahead.time_s, <, 0.8 * blind_s);
    CHECK_COMPARE(ahead.peak_over_limit, <, 1.0);
    const Words replay{"replay", folder.file("run.log"),    "--machine",  folder.file("machine.toml"),
                       "--tool", folder.file("tool.toml"),  "--verify",   folder.file("run.jsonl"),
                       "-o",     folder.file("replay.csv"), "--lock-step"};
    const test::Ended replayed = test::run_millforce(with(replay, with_map("part.map")));
    STRCMP_CONTAINS("looks ahead", replayed.error.c_str());
    LONGS_EQUAL(0, replayed.exit_code);  // each tick bit for bit

    const Milled second = folder.mill(with_map("seen.map"));
    CHECK_COMPARE(second.time_s, <, 0.9 * blind_s);
    CHECK_COMPARE(second.peak_over_limit, <, 1.0);
}

TEST(RunWithMap, a_map_of_a_block_that_lies_6_mm_off_is_dropped_by_name_on_the_page_too_and_the_limit_is_kept) {
    folder.preview("part.map", 6);
    const Milled milled = folder.mill(with_map("part.map"));
    CHECK_COMPARE(milled.peak_over_limit, <, 1.0);
    CHECK(has(milled.says, "vcan0: map_refuted\n"));
    CHECK(has(folder.text("run.jsonl"), "\"conditions\":[\"map_refuted\"]"));
    CHECK(has(folder.text("page/report.html"),
              "map_refuted: the part map does not fit this cut, and the controller goes on without it"));
}

TEST(RunWithMap, a_map_of_another_program_or_tool_is_refused_in_words) {
    folder.preview("part.map", 0);
    folder.write("part.ngc", part + "(another)\n");
    refuses("part.map", "part.map: made for another program ('part.ngc'; this is 'part.ngc'); make it again");
    folder.write("part.ngc", part);
    folder.write("tool.toml", test::with(folder.text("tool.toml"), "teeth = 4", "teeth = 3"));
    refuses("part.map", "part.map: made for another tool ('tool'; this is 'tool'); make it again");
}
