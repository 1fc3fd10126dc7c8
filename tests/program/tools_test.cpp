// SPDX-License-Identifier: Apache-2.0
#include "bridge.hpp"
#include "csv_rows.hpp"
#include "inputs.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>

#include "program_status/tool_frame.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

namespace {

/// machine.toml, and the tools 7 and 12 in the folder `tools`.
class ToolInputs : public Inputs {
  public:
    ToolInputs() {
        std::filesystem::create_directory(path("tools"));
        write("tools/T7.toml", tool_text);
        write("tools/T12.toml", with(tool_text, "tooth_force_limit_N = 700.0", "tooth_force_limit_N = 600.0"));
    }
    [[nodiscard]] std::vector<std::string> with_tools(std::vector<std::string> words) const {
        words.insert(words.end(), {"--machine", name("machine.toml"), "--tools", name("tools")});
        return words;
    }
};

const std::string machine_on_bus_without_program_status =
    with(machine_text, "[x]\n", "[x]\nrated_current_A = 12\n") +
    "[bus]\nprogram_status_id = 0\n[bus.x]\nnode_id = 2\n"
    "tpdo1 = [\"0x606C:32\", \"0x6078:16\"]\nvelocity_mm_s_per_unit = 0.001\n";

/// A recording of a spindle in air; tool and velocity of each row as given.
std::string recording(const std::function<std::string(int row)>& tool, const std::function<double(int row)>& velocity) {
    std::ostringstream text;
    text << "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s,programmed_feed_mm_s,tool\n";
    for (int k = 0; k < 400; ++k) {
        text << 0.001 * k << ',' << 0.4 * k << ",1.4,2.3," << velocity(k) << ",20," << tool(k) << '\n';
    }
    return text.str();
}

std::string hex_of(const hal::CanFrame& frame) {
    std::string text;
    for (const std::uint8_t byte : frame.data) {
        std::array<char, 3> digits{};
        std::snprintf(digits.data(), digits.size(), "%02X", byte);
        text += digits.data();
    }
    return text;
}

std::vector<std::string> tools_of(const std::string& csv) {
    std::vector<std::string> tools;
    for (const CsvRow& row : csv_rows(csv)) {
        tools.push_back(row.at("tool"));
    }
    return tools;
}

}  // namespace

TEST_GROUP(Tools) {
    ToolInputs inputs;

    Ended replay() {
        return run_millforce(inputs.with_tools({"replay", inputs.name("log.csv"), "-o", inputs.name("out.csv")}));
    }
    void folder_is_refused(const std::vector<std::string>& parts) {
        for (const std::vector<std::string>& words : {std::vector<std::string>{"serve", inputs.name("a.sock")},
                                                      {"run", "vcan0"},
                                                      {"replay", inputs.name("log.csv")}}) {
            STRCMP_EQUAL("", not_refused(run_millforce(inputs.with_tools(words)), parts).c_str());
        }
    }
};

TEST(Tools, serve_changes_the_tool_at_rest_and_says_which_one_it_is) {
    Program serve(inputs.with_tools({"serve", inputs.name("a.sock")}));
    {
        Bridge cnc(inputs.name("a.sock"));
        CHECK_FALSE(cnc.ask(7, 0.0F).tool_unknown);
        CHECK_FALSE(cnc.ask(12, 20.0F).tool_unknown);  // still tool 7
        CHECK_FALSE(cnc.ask(12, 0.0F).tool_unknown);
        const local_link::OverrideMessage unknown = cnc.ask(9, 0.0F);
        CHECK(unknown.tool_unknown && !unknown.hold);
        DOUBLES_EQUAL(0.75, static_cast<double>(unknown.ratio), 1e-7);
        CHECK_FALSE(cnc.ask(7, 0.0F).tool_unknown);
        UNSIGNED_LONGS_EQUAL(6, cnc.ask(7, 0.0F).heartbeat);
    }
    serve.interrupt(SIGTERM);
    serve.wait();
    LONGS_EQUAL(0, serve.exit_code());
    const std::string& reported = serve.error();
    const std::size_t first = reported.find("millforce: tool 7\n");
    const std::size_t waits =
        reported.find("another tool number: the limits of tool 7 hold until the axes rest\n", first);
    const std::size_t second = reported.find("millforce: tool 12\n", waits);
    const std::size_t none = reported.find("tool not known: the override is the operator's\n", second);
    CHECK(reported.find("millforce: tool 7\n", none) != std::string::npos);
}

TEST(Tools, the_check_at_the_start_sees_each_tool_of_the_folder) {
    inputs.write("tools/T12.toml", with(tool_text, "tooth_force_limit_N = 700.0", "tooth_force_limit_N = 5.0"));
    Program serve(inputs.with_tools({"serve", inputs.name("a.sock")}));
    { Bridge cnc(inputs.name("a.sock")); }
    serve.interrupt(SIGTERM);
    serve.wait();
    inputs.write("machine.toml", machine_on_bus_without_program_status);
    const std::string run_error = run_millforce(inputs.with_tools({"run", "vcan0"})).error;
    for (const std::string& error : {serve.error(), run_error}) {
        CHECK(contains(error, "millforce: tool 12: error: contact is seen from 10 N on"));
        CHECK_FALSE(contains(error, "tool 7: "));
    }
}

TEST(Tools, serve_refuses_the_bridge_of_an_older_layout_by_its_version) {
    Program serve(inputs.with_tools({"serve", inputs.name("a.sock")}));
    {
        Bridge old(inputs.name("a.sock"));
        local_link::SampleBytes bytes = encode(local_link::SampleMessage{});
        bytes[4] = 2;
        old.send(std::span<const std::uint8_t>(bytes).first(72));
        local_link::OverrideBytes answer{};
        UNSIGNED_LONGS_EQUAL(0, old.receive(answer));
    }
    serve.interrupt(SIGTERM);
    serve.wait();
    CHECK(contains(serve.error(), "invalid message of 72 bytes (another version of the layout): connection closed"));
}

TEST(Tools, a_folder_that_is_not_sound_is_refused_by_each_command_with_the_file) {
    inputs.write("log.csv", recording([](int) { return "7"; }, [](int) { return 0.0; }));
    inputs.write("tools/T3.toml", with(tool_text, "teeth = 4", "teeth = 4.5"));
    folder_is_refused({"tools/T3.toml", "tool.teeth"});
    std::filesystem::remove(inputs.path("tools/T3.toml"));
    inputs.write("tools/T007.toml", tool_text);
    folder_is_refused({"T7.toml: tool 7 is in T007.toml, too"});
}

TEST(Tools, one_tool_or_a_folder_must_be_given) {
    const std::vector<std::string> serve{"serve", inputs.name("a.sock"), "--machine", inputs.name("machine.toml")};
    STRCMP_EQUAL("", not_refused(run_millforce(serve), {"--tool, --tools: neither was given"}).c_str());
    std::vector<std::string> both = inputs.with_tools({"serve", inputs.name("a.sock")});
    both.insert(both.end(), {"--tool", inputs.name("tool.toml")});
    STRCMP_EQUAL("", not_refused(run_millforce(both), {"--tool, --tools: both were given"}).c_str());
}

TEST(Tools, a_bus_without_a_program_status_cannot_tell_a_tool) {
    inputs.write("machine.toml", machine_on_bus_without_program_status);
    const Ended ended = run_millforce(inputs.with_tools({"run", "vcan0"}));
    STRCMP_EQUAL("", not_refused(ended, {"--tools", "machine.toml: bus.program_status_id = 0"}).c_str());
}

TEST(Tools, of_a_folder_become_a_block_for_flash_that_is_printed_as_their_files) {
    const Ended written =
        run_millforce(inputs.with_tools({"parameters", "--write-block", inputs.name("parameters.bin")}));
    LONGS_EQUAL(0, written.exit_code);
    CHECK(contains(written.out, "1848 bytes, tools 7 12"));
    const Ended read = run_millforce({"parameters", "--read-block", inputs.name("parameters.bin")});
    LONGS_EQUAL(0, read.exit_code);
    const std::size_t first = read.out.find("# T7.toml");
    const std::size_t second = read.out.find("# T12.toml", first);
    CHECK(read.out.find("tooth_force_limit_N = 700.0", first) < second);
    CHECK(read.out.find("tooth_force_limit_N = 600.0", second) != std::string::npos);
}

TEST(Tools, beyond_sixteen_or_none_make_no_block) {
    for (int number = 20; number < 35; ++number) {
        inputs.write("tools/T" + std::to_string(number) + ".toml", tool_text);
    }
    const std::vector<std::string> write{"parameters", "--write-block", inputs.name("parameters.bin")};
    STRCMP_EQUAL("", not_refused(run_millforce(inputs.with_tools(write)), {"17 tools, expected 1 to 16"}).c_str());
    const std::vector<std::string> no_tool{"parameters", "--write-block", inputs.name("parameters.bin"), "--machine",
                                           inputs.name("machine.toml")};
    STRCMP_EQUAL("", not_refused(run_millforce(no_tool), {"--tool, --tools: neither was given"}).c_str());
    CHECK_FALSE(std::filesystem::exists(inputs.path("parameters.bin")));
}

TEST(Tools, replay_follows_the_column_of_a_recording) {
    // Tool 9 is not there; 12 comes in motion, and is taken at rest.
    inputs.write("log.csv", recording([](int k) { return k < 100 ? "7" : (k < 200 ? "9" : "12"); },
                                      [](int k) { return k > 150 && k < 300 ? 20.0 : 0.0; }));
    const Ended ended = replay();
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "the tool is not known in 10 of 20 rows"));
    std::vector<std::string> expected(5, "7");
    expected.insert(expected.end(), 10, "");
    expected.insert(expected.end(), 5, "12");
    CHECK(expected == tools_of(inputs.read("out.csv")));
    for (const CsvRow& row : csv_rows(inputs.read("out.csv"))) {
        CHECK((row.at("override") == "1") == row.at("tool").empty());
    }
}

TEST(Tools, replay_refuses_a_recording_that_has_no_tool_or_one_that_is_no_number) {
    inputs.write("log.csv", "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n0,0,3,2,10\n");
    STRCMP_EQUAL("", not_refused(replay(), {"log.csv:1", "expected the column tool with --tools"}).c_str());
    for (const char* number : {"-1", "7.5", "4294967296"}) {
        inputs.write("log.csv", recording([=](int) { return number; }, [](int) { return 0.0; }));
        STRCMP_EQUAL("", not_refused(replay(), {"log.csv:2", "tool", "expected the number of a tool"}).c_str());
    }
    CHECK_FALSE(std::filesystem::exists(inputs.path("out.csv")));
}

TEST(Tools, replay_follows_the_frames_of_a_candump_log) {
    inputs.write("machine.toml", with(with(machine_text, "[spindle]\n", "[spindle]\nrated_current_A = 12\n"), "[x]\n",
                                      "[x]\nrated_current_A = 12\n") +
                                     "[bus]\n[bus.spindle]\nnode_id = 1\ntpdo1 = [\"0x6064:32\", \"0x6078:16\"]\n"
                                     "[bus.x]\nnode_id = 2\ntpdo1 = [\"0x606C:32\", \"0x6078:16\"]\n"
                                     "velocity_mm_s_per_unit = 0.001\n");
    const auto tool_at = [](int k) { return k < 100 ? 7U : (k < 200 ? 9U : 12U); };
    std::string log;
    for (int k = 0; k < 300; ++k) {
        const auto line = [&](int after_us, const std::string& frame) {
            std::array<char, 100> buffer{};
            std::snprintf(buffer.data(), buffer.size(), "(1700000000.%06d) can0 %s\n", 1000 * k + after_us,
                          frame.c_str());
            log += buffer.data();
        };
        hal::CanFrame spindle;
        const unsigned count = 546U * static_cast<unsigned>(k);
        spindle.data = {static_cast<std::uint8_t>(count),
                        static_cast<std::uint8_t>(count >> 8U),
                        static_cast<std::uint8_t>(count >> 16U),
                        0,
                        0xA7,
                        0};
        if (k % 10 == 0) {
            line(0, "2FD#" + hex_of(program_status::encode_tool(tool_at(k), 0x2FD)));
        }
        line(100, "080#");
        line(250, "181#" + hex_of(spindle).substr(0, 12));
        line(400, "182#00000000A700");
    }
    inputs.write("log.csv", log);
    const Ended ended = replay();
    LONGS_EQUAL(0, ended.exit_code);
    const std::vector<std::string> tools = tools_of(inputs.read("out.csv"));
    UNSIGNED_LONGS_EQUAL(15, tools.size());
    STRCMP_EQUAL("7", tools[2].c_str());
    STRCMP_EQUAL("", tools[7].c_str());
    STRCMP_EQUAL("12", tools[12].c_str());
}

/// A part program with maps for the tools 7, 12 and 3; there is no tool 3 in the folder.
TEST_GROUP(MapsOfTools) {
    ToolInputs inputs;

    void setup() override {
        inputs.write("part.ngc", "G21 G90 G94\nS4000 M3\nG1 X10 F600\nG1 Y10\nM5\nM30\n");
        inputs.write("stock.toml",
                     "[stock]\nmin_x_mm = 0\nmin_y_mm = -10\nmax_x_mm = 10\nmax_y_mm = 10\ntop_mm = 0\n"
                     "cell_mm = 0.5\nstart_x_mm = -20\nstart_y_mm = 0\nstart_z_mm = 5\n");
        inputs.write("T3.toml", with(tool_text, "teeth = 4", "teeth = 3"));
        for (const auto& [tool, map] : {std::pair{"tools/T7.toml", "T7.map"},
                                        {"tools/T12.toml", "T12.map"},
                                        {"tools/T7.toml", "again.map"},
                                        {"T3.toml", "T3.map"}}) {
            LONGS_EQUAL(0, run_millforce({"preview", inputs.name("part.ngc"), "--stock", inputs.name("stock.toml"),
                                          "--tool", inputs.name(tool), "-o", inputs.name(map)})
                               .exit_code);
        }
    }

    [[nodiscard]] std::vector<std::string> serve(const std::vector<std::string>& maps) const {
        std::vector<std::string> words =
            inputs.with_tools({"serve", inputs.name("a.sock"), "--program", inputs.name("part.ngc")});
        for (const std::string& map : maps) {
            words.insert(words.end(), {"--map", inputs.name(map.c_str())});
        }
        return words;
    }
    void is_refused(const std::vector<std::string>& words, const std::string& why) const {
        STRCMP_EQUAL("", not_refused(run_millforce(words), {why}).c_str());
    }
    /// The block of a line, in air.
    static void mill(Bridge & cnc, std::uint32_t tool, std::uint32_t line) {
        cnc.ask(tool, 0.0F);
        cnc.sample.line = line;
        for (int k = 100; k >= 0; --k) {
            cnc.sample.distance_to_go_mm = 0.1F * static_cast<float>(k);
            cnc.ask(tool, 10.0F);
        }
        cnc.ask(tool, 0.0F);
    }
};

TEST(MapsOfTools, there_is_one_for_each_tool_of_the_folder_and_serve_says_whose_each_is) {
    Program served(serve({"T12.map", "T7.map"}));
    CHECK(served.says("waiting"));
    served.interrupt(SIGTERM);
    served.wait();
    LONGS_EQUAL(0, served.exit_code());
    CHECK(contains(served.error(), "T12.map: looks ahead in part.ngc, 40 mm of path, with T12\n"));
    CHECK(contains(served.error(), "T7.map: looks ahead in part.ngc, 40 mm of path, with T7\n"));
}

TEST(MapsOfTools, two_for_one_tool_and_one_for_none_are_refused_in_words) {
    is_refused(serve({"T7.map", "T12.map", "again.map"}), "again.map: a second map for T7, expected one for each tool");
    is_refused(serve({"T7.map", "T3.map"}), "T3.map: made for another tool ('T3') than those of ");
    inputs.write("part.ngc", "M30\n");
    is_refused(serve({"T7.map"}), "T7.map: made for another program ('part.ngc'");
    is_refused(
        {"serve", inputs.name("a.sock"), "--machine", inputs.name("machine.toml"), "--tool", inputs.name("tool.toml"),
         "--program", inputs.name("part.ngc"), "--map", inputs.name("T7.map"), "--map", inputs.name("T12.map")},
        "--map: 2 maps for one tool, expected one, or --tools");
}

TEST(MapsOfTools, each_tool_leaves_the_map_of_its_own_path_in_the_folder_of_learn) {
    std::vector<std::string> words = serve({});
    words.insert(words.end(), {"--learn", inputs.name("seen")});
    Program served(words);
    {
        Bridge cnc(inputs.name("a.sock"));
        mill(cnc, 7, 3);
        mill(cnc, 12, 4);
        mill(cnc, 9, 5);  // not among them
        mill(cnc, 7, 6);
    }
    served.interrupt(SIGTERM);
    served.wait();
    LONGS_EQUAL(0, served.exit_code());
    CHECK(contains(served.error(), "T7.map: 20 mm of path learnt"));
    CHECK(contains(served.error(), "T12.map: 10 mm of path learnt"));
    std::vector<std::string> ends;
    const std::string map = test::text_of(inputs.name("seen/T7.map"));
    for (const CsvRow& row : csv_rows(map.substr(map.find("path_mm,")))) {
        ends.push_back(row.at("line") + " to " + row.at("block_end_mm"));
    }
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    CHECK((ends == std::vector<std::string>{"3 to 10", "6 to 20"}));
    words.back() = inputs.name("part.ngc");
    is_refused(words, "part.ngc: cannot create the folder");
}

TEST(MapsOfTools, preview_makes_one_for_each_tool_that_the_program_uses) {
    inputs.write("part.ngc", "G21 G90 G94\nT7 M6\nS4000 M3\nG1 X10 F600\nT12 M6\nG1 X-10\nM5\nM30\n");
    std::vector<std::string> preview{"preview", inputs.name("part.ngc"), "--stock", inputs.name("stock.toml"),
                                     "--tools", inputs.name("tools"),    "-o",      inputs.name("maps")};
    const Ended ended = run_millforce(preview);
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.out, "T7.map: 30 mm of path, ") && contains(ended.out, "T12.map: 20 mm of path, "));
    Program served(serve({"maps/T7.map", "maps/T12.map"}));
    CHECK(served.says("maps/T12.map: looks ahead in part.ngc, 20 mm of path, with T12\n"));
    served.interrupt(SIGTERM);
    served.wait();
    inputs.write("tools/T12.toml", with(tool_text, "diameter_mm = 10", "diameter_mm = 8"));
    is_refused(serve({"maps/T7.map", "maps/T12.map"}), "maps/T12.map: made for another tool ('T12') than those of ");
    preview.insert(preview.end(), {"--tool", inputs.name("tool.toml")});
    is_refused(preview, "--tool, --tools: both were given, expected one of the two");
}

TEST(MapsOfTools, preview_of_a_tool_that_the_folder_lacks_is_refused_and_writes_nothing) {
    inputs.write("part.ngc", "T7 M6\nS4000 M3\nG1 X10 F600\nT3 M6\nG1 X5\nM30\n");
    std::vector<std::string> preview{"preview", inputs.name("part.ngc"), "--stock", inputs.name("stock.toml"),
                                     "--tools", inputs.name("tools"),    "-o",      inputs.name("maps")};
    is_refused(preview, "part.ngc:5: a feed of T3, which has no file: expected T3.toml, or --without-tool 3");
    CHECK_FALSE(std::filesystem::exists(inputs.path("maps")));
    preview.insert(preview.end(), {"--without-tool", "3"});
    LONGS_EQUAL(0, run_millforce(preview).exit_code);
    CHECK(std::filesystem::exists(inputs.path("maps/T7.map")));
    CHECK_FALSE(std::filesystem::exists(inputs.path("maps/T3.map")));
    inputs.write("part.ngc", "T3 M6\nS4000 M3\nG1 X10 F600\nM30\n");
    is_refused(preview, "part.ngc: it uses no tool of ");
    preview.back() = "12";
    is_refused(preview, "--without-tool 12: ");
}
