// SPDX-License-Identifier: Apache-2.0
#include "calibration/estimate.hpp"
#include "calibration/cutting_calibration.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;
using millforce::estimation::CutSide;
using millforce::estimation::CuttingLawForm;

namespace {

const std::filesystem::path measured_cuts = MILLFORCE_TEST_DATA "/milling_6061_train.csv";

const std::string law_text =
    "[machine]\nanything = 1\n[cutting]\nk_s_N_per_mm2 = 1014.0\np_s = -0.117\nk_1 = 0.39\np_1 = -0.226\nK_te_N_per_mm "
    "= 6.5\n"
    "K_re_N_per_mm = -1.1\nK_s_relative_sd = 0.06\nr_1_relative_sd = 0.04\nminimum_chip_thickness_mm = 0.01\n"
    "maximum_chip_thickness_mm = 0.04\n";

struct Run {
    int code = -1;
    std::string text;
    std::string error;
    std::string csv;
};

Run run_estimate(std::string_view conditions, std::string_view tool, bool to_file) {
    const TemporaryFolder folder;
    EstimateOptions options;
    options.conditions = folder.write("cuts.csv", conditions);
    options.tool = folder.write("tool.toml", tool);
    options.output = to_file ? folder.path("out.csv") : std::filesystem::path();
    std::ostringstream out;
    Run run;
    run.error = message_of<InputError>([&] { run.code = estimate(options, out); });
    run.text = out.str();
    run.csv = to_file ? folder.read("out.csv") : out.str();
    return run;
}

std::string error_of_tool(std::string_view tool) {
    return run_estimate("tool_diameter_mm,flutes,spindle_rad_s,feed_mm_s\n", tool, true).error;
}

const std::string header =
    "tool_diameter_mm,flutes,spindle_rad_s,axial_depth_mm,radial_width_mm,feed_mm_s,spindle_torque_Nm";

}  // namespace

TEST_GROUP(Estimate){};

TEST(Estimate, finds_the_depth_of_measured_cuts_from_torque_with_the_law_of_other_widths) {
    const auto rows = read_conditions(measured_cuts);
    double depth_error = 0.0;
    double width_error = 0.0;
    for (const CutRow& held_out : rows) {
        std::vector<CutRow> others;
        for (const CutRow& row : rows) {
            if (row.radial_width_mm != held_out.radial_width_mm) {
                others.push_back(row);
            }
        }
        const auto law = fit_cuts(others, CuttingLawForm::combined, CutSide::down).law;
        const RowEstimates e = estimate_row(law, CutSide::down, held_out);
        depth_error += std::abs(e.axial_depth_mm.value - 1.0) / static_cast<double>(rows.size());
        width_error += std::abs(e.radial_width_mm.value - held_out.radial_width_mm) / static_cast<double>(rows.size());
    }
    CHECK(depth_error < 0.05);
    CHECK(depth_error > 0.01);
    CHECK(width_error < 0.12);
    CHECK(width_error > 0.03);
}

TEST(Estimate, repeats_the_rows_and_appends_eight_columns) {
    const Run run = run_estimate(header + ",note\n6.35,3,300,1.0,3.175,5.75,0.11,\"a, b\"\n", law_text, false);
    STRCMP_EQUAL("", run.error.c_str());
    LONGS_EQUAL(0, run.code);
    const TemporaryFolder folder;
    CsvReader csv(folder.write("out.csv", run.csv));
    CHECK(csv.next_row());
    CHECK(csv.row_text().starts_with("6.35,3,300,1.0,3.175,5.75,0.11,\"a, b\","));
    for (const char* name : {"predicted_spindle_torque_Nm", "predicted_normal_force_N", "axial_depth_from_torque_mm",
                             "radial_width_from_torque_mm"}) {
        CHECK(csv.required_number(csv.require(name)) > 0.0);
        CHECK(csv.required_number(csv.require(std::string(name) + "_sd")) > 0.0);
    }
    // Depth and torque are proportional.
    const double torque = csv.number(csv.require("predicted_spindle_torque_Nm"));
    DOUBLES_EQUAL(0.11 / torque, csv.number(csv.require("axial_depth_from_torque_mm")), 1e-12);
}

TEST(Estimate, of_a_foretold_torque_returns_depth_and_width) {
    ToolLaw tool;
    {
        const TemporaryFolder folder;
        tool = read_tool_law(folder.write("tool.toml", law_text));
    }
    CutRow row{6.35, 3, 300, 1.7, 2.0, 5.75, no_estimate, no_estimate, no_estimate};
    for (const CutSide side : {CutSide::down, CutSide::up}) {
        for (const double width : {0.05, 0.5, 2.0, 5.0, 6.3}) {
            row.radial_width_mm = width;
            row.spindle_torque_Nm = no_estimate;
            row.spindle_torque_Nm = estimate_row(tool.law, side, row).spindle_torque_Nm.value;
            const RowEstimates e = estimate_row(tool.law, side, row);
            DOUBLES_EQUAL(width, e.radial_width_mm.value, 1e-9);
            DOUBLES_EQUAL(1.7, e.axial_depth_mm.value, 1e-9);
            DOUBLES_EQUAL(e.axial_depth_mm.value * e.spindle_torque_Nm.sd / e.spindle_torque_Nm.value,
                          e.axial_depth_mm.sd, 1e-9);
        }
    }
}

TEST(Estimate, leaves_cells_empty_where_there_is_no_estimate) {
    const auto cells = [&](const std::string& row) {
        const Run run = run_estimate(header + "\n" + row + "\n", law_text, false);
        STRCMP_EQUAL("", run.error.c_str());
        const std::string line = run.csv.substr(run.csv.find('\n') + 1);
        return line.substr(row.size());
    };
    // Neither depth nor width: torque, or its ratio to the force, does not tell the width.
    STRCMP_EQUAL(",,,,,,,,\n", cells("6.35,3,300,,,5.75,0.11").c_str());
    // No torque: forces alone.
    CHECK(cells("6.35,3,300,1.0,3.175,5.75,").ends_with(",,,,\n"));
    CHECK(!cells("6.35,3,300,1.0,3.175,5.75,").starts_with(",,"));
    // A torque that is not positive, and one beyond any slot of this depth.
    CHECK(cells("6.35,3,300,1.0,3.175,5.75,-0.01").ends_with(",,,,\n"));
    CHECK(cells("6.35,3,300,1.0,3.175,5.75,5.0").ends_with(",,\n"));
}

TEST(Estimate, with_a_file_prints_errors_and_the_rows_outside_the_calibrated_range) {
    const TemporaryFolder folder;
    folder.write("tool.toml", law_text);
    EstimateOptions options{measured_cuts, folder.path("tool.toml"), folder.path("out.csv"), CutSide::unknown};
    std::ostringstream out;
    LONGS_EQUAL(0, estimate(options, out));
    CHECK(contains(out.str(), "27 rows"));
    CHECK(contains(out.str(), "predicted_normal_force_N: 2."));
    CHECK(contains(out.str(), "outside the calibrated chip thickness of 0.01 to 0.04 mm"));
    LONGS_EQUAL(2, folder.file_count());
}

TEST(Estimate, writes_nothing_where_a_row_is_bad) {
    const std::string rows = header + "\n6.35,3,300,1.0,3.175,5.75,0.11\n6.35,3,300,1.0,wide,5.75,0.11\n";
    for (const bool to_file : {true, false}) {
        const Run run = run_estimate(rows, law_text, to_file);
        CHECK(contains(run.error, "cuts.csv:3: column 'radial_width_mm': 'wide' is not a number"));
        STRCMP_EQUAL("", run.csv.c_str());
    }
    CHECK(contains(run_estimate(header + ",predicted_normal_force_N\n", law_text, true).error, "is there already"));
}

TEST(Estimate, names_place_key_and_expectation_in_a_bad_tool_file) {
    CHECK(contains(error_of_tool("[cutting\n"), "tool.toml:1:"));
    CHECK(contains(error_of_tool("[tool]\n"), "no table [cutting]"));
    CHECK(contains(error_of_tool("[cutting]\np_s = -0.1\n"),
                   "tool.toml:1:1: cutting.k_s_N_per_mm2: missing, expected a number from 1 to 1000000"));
    CHECK(contains(error_of_tool(law_text + "k_te_N_per_m = 1.0\n"),
                   "cutting.k_te_N_per_m: unknown key; did you mean K_te_N_per_mm?"));
    CHECK(contains(error_of_tool("[cutting]\nk_s_N_per_mm2 = \"much\"\n"),
                   "tool.toml:2:17: cutting.k_s_N_per_mm2 = \"much\": expected a number from 1 to 1000000"));
    CHECK(contains(error_of_tool("[cutting]\nk_s_N_per_mm2 = nan\n"), "expected a number from"));
    CHECK(contains(error_of_tool("[cutting]\nk_s_N_per_mm2 = 900\np_s = -1.5\n"), "cutting.p_s = -1.5: expected"));
    CHECK(contains(error_of_tool(law_text + "cut_side = \"left\"\n"), "\"left\": expected one of down, up"));
    CHECK(!message_of<InputError>([] { read_tool_law("/nonexistent/tool.toml"); }).empty());
}

TEST(Estimate, refuses_a_speed_or_a_feed_in_another_unit_and_names_the_line) {
    const auto error_of_cut = [](std::string_view speed, std::string_view feed) {
        return run_estimate(header + fmt::format("\n10,2,600,2,5,20,1\n10,2,{},2,5,{},1\n", speed, feed), law_text,
                            true)
            .error;
    };
    STRCMP_EQUAL("", error_of_cut("600", "20").c_str());
    STRCMP_CONTAINS("cuts.csv:3: column 'spindle_rad_s'", error_of_cut("30000", "20").c_str());
    STRCMP_CONTAINS("is it in 1/min", error_of_cut("30000", "20").c_str());
    STRCMP_CONTAINS("is spindle_rad_s in 1/min", error_of_cut("5730", "0.9").c_str());
    STRCMP_CONTAINS("is it in mm/min?", error_of_cut("600", "1200").c_str());
}

TEST(Estimate, asks_about_torques_that_are_far_from_the_tools_law) {
    const auto of_torque = [](double torque_Nm) {
        return run_estimate(header + fmt::format("\n10,2,600,2,5,20,{}\n", torque_Nm), law_text, true);
    };
    CHECK_EQUAL(0, of_torque(1.0).code);
    for (const double torque_Nm : {0.01, 100.0, -1.0}) {
        const Run run = of_torque(torque_Nm);
        CHECK_EQUAL(1, run.code);
        STRCMP_CONTAINS("warning: spindle_torque_Nm is ", run.text.c_str());
        CHECK(!run.csv.empty());
    }
}
