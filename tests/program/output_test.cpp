// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

#include <chrono>
#include <cstdlib>
#include <thread>

using namespace millforce::test;

/// Outputs that are full, closed or the input itself; signals that end a program.

namespace {

/// By a shell, for its redirections. "{}" stands for the program.
int exit_code_of(std::string command) {
    for (std::size_t at = command.find("{}"); at != std::string::npos; at = command.find("{}")) {
        command.replace(at, 2, MILLFORCE_PROGRAM);
    }
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

const std::string recording =
    "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n0,0,3,2,10\n0.001,0.4,3,2,10\n";
const std::string conditions =
    "tool_diameter_mm,flutes,spindle_rad_s,feed_mm_s,axial_depth_mm,radial_width_mm,spindle_torque_Nm\n"
    "10,4,400,15,5,3,2\n";

}  // namespace

TEST_GROUP(Output) {
    Inputs in;

    std::string machine_and_tool() {
        return " --machine " + in.name("machine.toml") + " --tool " + in.name("tool.toml");
    }
};

TEST(Output, a_full_standard_output_is_a_failure) {
    in.write("log.csv", recording);
    in.write("cuts.csv", conditions);
    LONGS_EQUAL(2, exit_code_of("{} --help >/dev/full 2>/dev/null"));
    LONGS_EQUAL(2, exit_code_of("{} replay " + in.name("log.csv") + machine_and_tool() + " >/dev/full 2>/dev/null"));
    LONGS_EQUAL(2, exit_code_of("{} estimate " + in.name("cuts.csv") + " --tool " + in.name("tool.toml") +
                                " >/dev/full 2>/dev/null"));
    LONGS_EQUAL(2, exit_code_of("{} simulate " + in.name("scenario.toml") + " >/dev/full 2>/dev/null"));
}

TEST(Output, an_input_is_not_overwritten_by_whatever_name) {
    in.write("log.csv", recording);
    in.write("cuts.csv", conditions);
    std::filesystem::create_symlink(in.path("cuts.csv"), in.path("link.csv"));
    STRCMP_EQUAL("", not_refused(run_millforce({"estimate", in.name("cuts.csv"), "--tool", in.name("tool.toml"), "-o",
                                                in.name("link.csv")}),
                                 {"link.csv", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(run_millforce({"replay", in.name("log.csv"), "--machine", in.name("machine.toml"),
                                                "--tool", in.name("tool.toml"), "-o", in.name("tool.toml")}),
                                 {"tool.toml", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL(conditions.c_str(), in.read("cuts.csv").c_str());
    const std::string stock =
        "[stock]\nmin_x_mm = 0\nmin_y_mm = -10\nmax_x_mm = 10\nmax_y_mm = 10\ntop_mm = 0\ncell_mm = 0.5\n"
        "start_x_mm = -20\nstart_y_mm = 0\nstart_z_mm = 5\n";
    in.write("part.ngc", "S4000 M3\nG1 X10 F600\nM30\n");
    in.write("stock.toml", stock);
    STRCMP_EQUAL("", not_refused(run_millforce({"preview", in.name("part.ngc"), "--stock", in.name("stock.toml"),
                                                "--tool", in.name("tool.toml"), "-o", in.name("stock.toml")}),
                                 {"stock.toml", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL(stock.c_str(), in.read("stock.toml").c_str());
    const std::string block_file = in.name("tool.toml");
    STRCMP_EQUAL("", not_refused(run_millforce({"parameters", "--write-block", block_file, "--machine",
                                                in.name("machine.toml"), "--tool", block_file}),
                                 {"tool.toml", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(run_millforce({"cut-table", in.name("scenario.toml"), "-o", in.name("scenario.toml")}),
                                 {"scenario.toml", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(run_millforce({"simulate", in.name("scenario.toml"), "--out", in.name("out"),
                                                "--learn", in.name("tool.toml")}),
                                 {"tool.toml", "would be overwritten"})
                         .c_str());
}

TEST(Output, a_table_without_rows_and_a_folder_in_place_of_a_file_are_refused) {
    in.write("cuts.csv", conditions.substr(0, conditions.find('\n') + 1));
    STRCMP_EQUAL("", not_refused(run_millforce({"estimate", in.name("cuts.csv"), "--tool", in.name("tool.toml")}),
                                 {"cuts.csv", "no rows after the header"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(run_millforce({"estimate", in.name("cuts.csv"), "--tool", in.path("").string()}),
                                 {"is a folder"})
                         .c_str());
}

TEST(Output, a_file_of_parameters_that_nests_without_end_is_refused) {
    in.write("cuts.csv", conditions);
    std::string dotted = "a";
    for (int k = 0; k < 50'000; ++k) {
        dotted += ".a";
    }
    const std::string nested(50'000, '[');
    for (const std::string& text :
         {dotted + " = 1\n", "[" + dotted + "]\n", "a = {" + dotted + " = 1}\n", "a = " + nested}) {
        in.write("deep.toml", text);
        STRCMP_EQUAL("", not_refused(run_millforce({"estimate", in.name("cuts.csv"), "--tool", in.name("deep.toml")}),
                                     {"deep.toml:1"})
                             .c_str());
    }
}

TEST(Output, no_unfinished_file_is_left_by_a_signal) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        Program program(
            {"simulate", in.name("scenario.toml"), "--out", in.name("results"), "--record", in.name("recording.csv")});
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        program.interrupt(signal);
        program.wait();
        for (const auto& entry : std::filesystem::recursive_directory_iterator(in.path(""))) {
            CHECK(entry.path().string().find(".unfinished") == std::string::npos);
        }
    }
}
