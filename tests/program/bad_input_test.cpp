// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

const std::string log_text =
    "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n0,0,3,2,10\n0.001,0.4,3,2,10\n0.002,0.8,3,"
    "2,10\n";

}  // namespace

TEST_GROUP(BadInput) {
    Inputs inputs;

    void setup() override {
        inputs.write("log.csv", log_text);
        inputs.write("out.csv", "as before");
    }

    /// The program refuses, and writes nothing: an earlier result stays as it was.
    void check_refused(const Ended& ended, const std::vector<std::string>& parts) {
        STRCMP_EQUAL("", not_refused(ended, parts).c_str());
        STRCMP_EQUAL("as before", inputs.read("out.csv").c_str());
        LONGS_EQUAL(5, inputs.file_count());
    }
    void machine_is_refused(const std::string& text, const std::vector<std::string>& parts) {
        inputs.write("machine.toml", text);
        check_refused(inputs.replay(), parts);
        inputs.write("machine.toml", machine_text);
    }
    void tool_is_refused(const std::string& text, const std::vector<std::string>& parts) {
        inputs.write("tool.toml", text);
        check_refused(inputs.replay(), parts);
        inputs.write("tool.toml", tool_text);
    }
    void log_is_refused(const std::string& text, const std::vector<std::string>& parts) {
        inputs.write("log.csv", text);
        check_refused(inputs.replay(), parts);
    }
    /// Simulated into a folder that then must hold nothing; the folder itself goes.
    void scenario_is_refused(const std::string& text, const std::vector<std::string>& parts) {
        inputs.write("scenario.toml", text);
        const Ended ended = run_millforce({"simulate", inputs.name("scenario.toml"), "--out", inputs.name("results")});
        std::filesystem::remove(inputs.path("results"));
        check_refused(ended, parts);
    }
};

TEST(BadInput, a_socket_that_cannot_be_is_refused) {
    const auto serve = [&](const std::string& socket) {
        return run_millforce(
            {"serve", socket, "--machine", inputs.name("machine.toml"), "--tool", inputs.name("tool.toml")});
    };
    check_refused(serve(inputs.name("log.csv")), {"log.csv", "is there and no socket"});
    check_refused(serve(inputs.name("nowhere/a.sock")), {"nowhere/a.sock", "No such file or directory"});
    check_refused(serve("/" + std::string(200, 'x')), {"expected the path of a socket, at most 107 characters"});
}

TEST(BadInput, the_good_input_passes) {
    const Ended ended = inputs.replay();
    LONGS_EQUAL(0, ended.exit_code);
    STRCMP_EQUAL("", ended.error.c_str());
    CHECK(inputs.read("out.csv").starts_with("time_s,state,"));
    LONGS_EQUAL(5, inputs.file_count());
}

TEST(BadInput, a_missing_file_is_named) {
    const auto refused = [&](std::vector<std::string> words) {
        check_refused(run_millforce(words), {"nowhere", "no such file"});
    };
    refused({"simulate", inputs.name("nowhere.toml"), "--out", inputs.name("results")});
    refused({"bench", inputs.name("nowhere.toml")});
    refused({"cut-table", inputs.name("nowhere.toml"), "-o", inputs.name("out.csv")});
    refused({"estimate", inputs.name("log.csv"), "--tool", inputs.name("nowhere.toml")});
    refused({"replay", inputs.name("log.csv"), "--machine", inputs.name("nowhere.toml"), "--tool",
             inputs.name("tool.toml"), "-o", inputs.name("out.csv")});
    check_refused(run_millforce({"calibrate", "friction", inputs.name("nowhere.csv"), "-o", inputs.name("out.csv")}),
                  {"nowhere.csv"});
    check_refused(run_millforce({"calibrate", "cutting", inputs.name("nowhere.csv"), "-o", inputs.name("out.csv")}),
                  {"nowhere.csv"});
}

TEST(BadInput, what_is_not_toml_is_refused_with_line_and_column) {
    machine_is_refused("[spindle]\nK_t1_Nm_per_A = 0.7\n[x\n", {"machine.toml:3:", "not valid TOML"});
    machine_is_refused("time_s,x\n1,2\n", {"machine.toml:1:", "not valid TOML"});
    machine_is_refused(std::string("\x7f"
                                   "ELF\0\1\2",
                                   7),
                       {"machine.toml:1:"});
    machine_is_refused(machine_text + "[x]\n", {"machine.toml:15:"});  // a table given twice
}

TEST(BadInput, an_unknown_key_is_refused_with_the_nearest_one) {
    machine_is_refused(with(machine_text, "K_x3_A", "K_x3_Amp"),
                       {"machine.toml:10:", "x.K_x3_Amp", "did you mean K_x3_A?"});
    machine_is_refused(with(machine_text, "[x]", "[spindel]\n[x]"), {"spindel", "did you mean spindle?"});
    tool_is_refused(with(tool_text, "teeth", "tooths"), {"tool.teeth: missing"});
    tool_is_refused(with(tool_text, "k_1 = 0.376", "k_1 = 0.376\nk_2_se = 0.1"), {"cutting.k_2_se: unknown key"});
    scenario_is_refused(with(scenario_text, "seed", "sed"), {"scenario.toml:3:", "did you mean seed?"});
}

TEST(BadInput, a_missing_required_key_is_named_with_its_range) {
    machine_is_refused(with(machine_text, "K_t1_Nm_per_A = 0.70\n", ""),
                       {"spindle.K_t1_Nm_per_A: missing, expected a number from 0.0001 to 10000"});
    tool_is_refused(with(tool_text, "diameter_mm = 10.0\n", ""), {"tool.toml", "tool.diameter_mm: missing"});
    scenario_is_refused(with(scenario_text, "length_mm = 30\n", ""), {"profile.length_mm: missing"});
}

TEST(BadInput, a_value_out_of_range_not_finite_or_of_the_wrong_type_is_shown) {
    const std::string mass = "mass_kg = 250.0";
    machine_is_refused(with(machine_text, mass, "mass_kg = -1"), {"machine.toml:13:", "x.mass_kg = -1", "from 0 to"});
    machine_is_refused(with(machine_text, mass, "mass_kg = nan"), {"x.mass_kg = nan", "expected a number"});
    machine_is_refused(with(machine_text, mass, "mass_kg = inf"), {"x.mass_kg = inf", "expected a number"});
    machine_is_refused(with(machine_text, mass, "mass_kg = 1e400"), {"machine.toml:13:"});
    machine_is_refused(with(machine_text, mass, "mass_kg = \"250\""), {"x.mass_kg = \"250\"", "expected a number"});
    machine_is_refused(with(machine_text, mass, "mass_kg = [250]"), {"x.mass_kg", "expected a number"});
    machine_is_refused(with(machine_text, mass, "mass_kg_se = -0.1"), {"x.mass_kg_se = -0.1"});
    tool_is_refused(with(tool_text, "\"down\"", "\"sideways\""), {"tool.side = \"sideways\"", "down, up, centred"});
    scenario_is_refused(with(scenario_text, "feed_mm_min = 1200", "feed_mm_min = 0"), {"profile.feed_mm_min = 0"});
}

TEST(BadInput, a_scenario_names_the_tool_or_program_that_is_not_there) {
    scenario_is_refused(with(scenario_text, "tool.toml", "lost.toml"), {"lost.toml: no such file"});
    scenario_is_refused(
        "machine = \"machine.toml\"\ntool = \"tool.toml\"\nprogram = \"lost.ngc\"\n[stock]\nmin_x_mm = 0\n"
        "min_y_mm = 0\nmax_x_mm = 9\nmax_y_mm = 9\n[material]\nK_tc_N_mm2 = 900\nK_rc_N_mm2 = 300\n",
        {"lost.ngc: no such file"});
}

TEST(BadInput, an_error_of_the_part_program_has_file_line_and_column) {
    const TemporaryFolder other;
    other.write("machine.toml", machine_text);
    other.write("tool.toml", tool_text);
    other.write("part.ngc", "G21 G90\nS4000 M3\nG1 X10 Y F300\nM30\n");
    const auto scenario =
        other.write("part.toml",
                    "machine = \"machine.toml\"\ntool = \"tool.toml\"\nprogram = \"part.ngc\"\n[stock]\nmin_x_mm = 0\n"
                    "min_y_mm = 0\nmax_x_mm = 9\nmax_y_mm = 9\n[material]\nK_tc_N_mm2 = 900\nK_rc_N_mm2 = 300\n");
    const Ended ended = run_millforce({"simulate", scenario.string(), "--out", other.path("results").string()});
    STRCMP_EQUAL("", not_refused(ended, {"part.ngc:3:8"}).c_str());
    CHECK(!std::filesystem::exists(other.path("results") / "summary.json"));
}

TEST(BadInput, a_missing_column_is_refused_with_the_nearest_one) {
    log_is_refused(with(log_text, "spindle_current_A", "spindel_current_A"),
                   {"log.csv:1:", "spindle_current_A", "spindel_current_A"});
    log_is_refused(with(log_text, "x_velocity_mm_s", "x_speed"), {"log.csv:1:", "x_velocity_mm_s"});
}

TEST(BadInput, a_bad_cell_is_refused_with_its_line_and_column) {
    const std::string row = "0.002,0.8,3";
    log_is_refused(with(log_text, row, "0.002,0.8,three"), {"log.csv:4:", "spindle_current_A", "three"});
    log_is_refused(with(log_text, row, "0.002,0.8,nan"), {"log.csv:4:", "spindle_current_A", "nan"});
    log_is_refused(with(log_text, row, "0.002,0.8,1e999"), {"log.csv:4:", "spindle_current_A"});
    log_is_refused(with(log_text, row, "0.001,0.8,3"), {"log.csv:4:", "time_s", "0.001 after 0.001"});
    log_is_refused(with(log_text, row, "-5,0.8,3"), {"log.csv:4:", "time_s", "-5 after 0.001"});
    log_is_refused(with(log_text, row, "0.002,8e7,3"), {"log.csv:4:", "spindle_angle_rad"});
}

TEST(BadInput, a_truncated_or_empty_file_is_refused) {
    log_is_refused(log_text.substr(0, log_text.size() - 8), {"log.csv:4:"});
    log_is_refused("", {"log.csv"});
    log_is_refused("time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n", {"log.csv", "no rows"});
    log_is_refused(std::string("time_s\0spindle", 14), {"log.csv:1:"});
}

TEST(BadInput, an_output_that_cannot_be_written_is_named) {
    const auto written_to = [&](const std::string& target) {
        return run_millforce({"cut-table", inputs.name("scenario.toml"), "-o", target});
    };
    check_refused(written_to(inputs.name("no/such/folder/cuts.csv")), {"cuts.csv: cannot be written"});
    check_refused(run_millforce({"replay", inputs.name("log.csv"), "--machine", inputs.name("machine.toml"), "--tool",
                                 inputs.name("tool.toml"), "-o", inputs.name("no/such/folder/out.csv")}),
                  {"out.csv: cannot be written"});
    check_refused(written_to("/proc/cuts.csv"), {"/proc/cuts.csv: cannot be written"});
    check_refused(written_to(inputs.path("").string()), {"is a folder"});
    check_refused(run_millforce({"simulate", inputs.name("scenario.toml"), "--out", inputs.name("log.csv")}),
                  {"log.csv"});
    check_refused(run_millforce({"simulate", inputs.name("scenario.toml"), "--out", "/proc"}), {"/proc/summary.json"});
}

TEST(BadInput, a_calibration_that_is_refused_prints_no_report) {
    const std::string rows =
        "6.35,3,300,1,1.0,2.0,0.0205,6.66\n6.35,3,300,1,2.2,2.0,0.0374,13.46\n6.35,3,300,1,2.2,5.75,0.08,30\n";
    inputs.write("log.csv",
                 "tool_diameter_mm,flutes,spindle_rad_s,axial_depth_mm,radial_width_mm,feed_mm_s,spindle_torque_Nm,"
                 "normal_force_N\n" +
                     rows + rows);
    check_refused(run_millforce({"calibrate", "cutting", inputs.name("log.csv"), "-o", inputs.name("out.csv")}),
                  {"log.csv", "3 cuts with 6 measured values for the 6 parameters of the combined law"});
}
