// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_calibration.hpp"
#include "calibration/estimate.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;
using millforce::estimation::CutSide;
using millforce::estimation::CuttingLawForm;

namespace {

const std::filesystem::path measured_cuts = MILLFORCE_TEST_DATA "/milling_6061_train.csv";

std::vector<CutRow> measured() {
    return read_conditions(measured_cuts);
}

HeldOutErrors without_feed(double feed_mm_s, CuttingLawForm form) {
    return held_out_errors(measured(), form, CutSide::down,
                           [=](const CutRow& row) { return row.feed_mm_s == feed_mm_s; });
}

std::string error_of(std::string_view data) {
    const TemporaryFolder folder;
    CuttingCalibrationOptions options;
    options.data = {folder.write("cuts.csv", data)};
    options.output = folder.path("out.toml");
    std::ostringstream out;
    const std::string message = message_of<InputError>([&] { calibrate_cutting(options, out); });
    LONGS_EQUAL(1, folder.file_count());
    return message;
}

struct Ended {
    std::string text;
    toml::table toml;

    double number(const char* key) const { return toml["cutting"][key].value_or(std::nan("")); }
};

/// A calibration that is done.
Ended calibrate(std::string_view data) {
    const TemporaryFolder folder;
    CuttingCalibrationOptions options;
    options.data = {folder.write("cuts.csv", data)};
    options.output = folder.path("out.toml");
    std::ostringstream out;
    LONGS_EQUAL(0, calibrate_cutting(options, out));
    return {out.str(), toml::parse(folder.read("out.toml"))};
}

const std::string header =
    "tool_diameter_mm,flutes,spindle_rad_s,axial_depth_mm,radial_width_mm,feed_mm_s,spindle_torque_Nm,normal_force_N\n";

/// The measured rows for which `keep` is true, as a file.
template <typename Keep>
std::string measured_rows(Keep keep) {
    std::ostringstream text;
    text << header;
    for (const CutRow& r : measured()) {
        if (keep(r)) {
            text << r.tool_diameter_mm << ',' << r.flutes << ',' << r.spindle_rad_s << ',' << r.axial_depth_mm << ','
                 << r.radial_width_mm << ',' << r.feed_mm_s << ',' << r.spindle_torque_Nm << ',' << r.normal_force_N
                 << '\n';
        }
    }
    return text.str();
}

}  // namespace

TEST_GROUP(CuttingCalibration){};

TEST(CuttingCalibration, foretells_measured_cuts_of_each_width_from_the_other_widths) {
    const auto errors = leave_one_width_out(measured(), CuttingLawForm::combined, CutSide::down);
    LONGS_EQUAL(27, errors.cuts);
    CHECK(errors.normal_force < 0.03);
    CHECK(errors.torque < 0.03);
    CHECK(errors.axial_depth_mm < 0.035);
    CHECK(errors.normal_force > 0.01);  // better than the cuts' own scatter would mean that it saw them
    CHECK(errors.within_two_sd > 0.9);
}

TEST(CuttingCalibration, foretells_measured_cuts_of_the_middle_feed_from_the_other_two) {
    const auto errors = without_feed(5.75, CuttingLawForm::combined);
    LONGS_EQUAL(9, errors.cuts);
    CHECK(errors.normal_force < 0.035);
    CHECK(errors.torque < 0.035);
    CHECK(errors.axial_depth_mm < 0.035);
    CHECK(errors.normal_force > 0.01);
    CHECK(errors.within_two_sd > 0.9);
}

TEST(CuttingCalibration, extrapolates_to_thin_chips_better_than_the_linear_edge_law_and_within_its_stated_doubt) {
    const auto combined = without_feed(2.0, CuttingLawForm::combined);
    const auto edge = without_feed(2.0, CuttingLawForm::linear_edge);
    CHECK(edge.torque > 0.1);
    CHECK(edge.normal_force > 0.1);
    CHECK(combined.torque < 0.07);
    CHECK(combined.normal_force < 0.035);
    CHECK(combined.within_two_sd > 0.9);
}

TEST(CuttingCalibration, extrapolates_to_thick_chips_within_its_stated_doubt) {
    const auto errors = without_feed(9.5, CuttingLawForm::combined);
    CHECK(errors.torque < 0.07);
    CHECK(errors.normal_force < 0.07);
    CHECK(errors.within_two_sd > 0.85);  // 16 of 18: one cut, 1.0 mm wide, is odd in both
}

TEST(CuttingCalibration, finds_that_the_measured_cuts_are_down_milling) {
    const TemporaryFolder folder;
    CuttingCalibrationOptions options;
    options.data = {measured_cuts};
    options.output = folder.path("out.toml");
    std::ostringstream out;
    LONGS_EQUAL(0, calibrate_cutting(options, out));
    CHECK(contains(out.str(), "down milling (up milling would need an edge that pulls)"));
    CHECK(contains(out.str(), "K_re_N_per_mm is smaller than its standard error"));
    CHECK(contains(folder.read("out.toml"), "cut_side = \"down\""));
    const auto up = fit_cuts(measured(), CuttingLawForm::combined, CutSide::up);
    CHECK(up.parameters(millforce::estimation::cutting_r_1) < -0.5);
}

TEST(CuttingCalibration, writes_a_table_from_which_estimate_reads_the_same_law) {
    const TemporaryFolder folder;
    CuttingCalibrationOptions options;
    options.data = {measured_cuts};
    options.output = folder.path("out.toml");
    std::ostringstream out;
    calibrate_cutting(options, out);
    const ToolLaw read = read_tool_law(folder.path("out.toml"));
    const auto fit = fit_cuts(measured(), CuttingLawForm::combined, CutSide::down);
    DOUBLES_EQUAL(fit.law.k_s_N_per_mm2, read.law.k_s_N_per_mm2, 0.0);
    DOUBLES_EQUAL(fit.law.p_s, read.law.p_s, 0.0);
    DOUBLES_EQUAL(fit.law.k_1, read.law.k_1, 0.0);
    DOUBLES_EQUAL(fit.law.p_1, read.law.p_1, 0.0);
    DOUBLES_EQUAL(fit.law.K_te_N_per_mm, read.law.K_te_N_per_mm, 0.0);
    DOUBLES_EQUAL(fit.law.K_re_N_per_mm, read.law.K_re_N_per_mm, 0.0);
    DOUBLES_EQUAL(fit.law.K_s_exponent_sd, read.law.K_s_exponent_sd, 0.0);
    DOUBLES_EQUAL(fit.law.maximum_chip_thickness_mm, read.law.maximum_chip_thickness_mm, 0.0);
    CHECK(read.side == CutSide::down);
}

TEST(CuttingCalibration, refuses_cuts_that_cannot_determine_a_parameter_and_names_the_missing_cut) {
    CHECK(contains(
        error_of(measured_rows([](const CutRow& r) { return r.feed_mm_s == 5.75; })),
        "'K_te_N_per_mm' cannot be separated from 'k_s_N_per_mm2': all cuts have about 0.04014 mm feed per tooth; "
        "expected cuts at a second feed"));
    CHECK(contains(
        error_of(header + "6.35,3,300,1,6.35,2,0.1,20\n6.35,3,300,1,6.35,5,0.2,40\n6.35,3,300,1,6.35,9,0.3,60\n"
                          "6.35,3,300,1,6.35,3,0.13,27\n"),
        "'k_1' cannot be determined"));
    CHECK(contains(error_of(header), "'k_s_N_per_mm2' cannot be determined: no row"));
    CHECK(contains(error_of("tool_diameter_mm,flutes,spindle_rad_s,axial_depth_mm,radial_width_mm,feed_mm_s,"
                            "spindle_torque_Nm\n"),
                   "no column 'normal_force_N', needed for r_1"));
}

TEST(CuttingCalibration, counts_a_repeated_row_once_and_says_so) {
    const auto all = [](const CutRow&) { return true; };
    const std::string rows = measured_rows(all);
    const Ended once = calibrate(rows);
    const Ended twice = calibrate(rows + rows.substr(header.size()));
    DOUBLES_EQUAL(once.number("k_s_N_per_mm2_se"), twice.number("k_s_N_per_mm2_se"), 0.0);
    CHECK(contains(twice.text,
                   "27 rows repeat an earlier row exactly and are not counted again: cuts.csv:29, cuts.csv:30"));
    CHECK(!contains(once.text, "repeat"));
}

TEST(CuttingCalibration, states_its_doubt_at_a_chip_that_was_cut) {
    for (const auto form : {CuttingLawForm::combined, CuttingLawForm::linear_edge, CuttingLawForm::power}) {
        const auto law = fit_cuts(measured(), form, CutSide::down).law;
        CHECK(law.reference_chip_thickness_mm >= law.minimum_chip_thickness_mm);
        CHECK(law.reference_chip_thickness_mm <= law.maximum_chip_thickness_mm);
    }
}

TEST(CuttingCalibration, refuses_impossible_cuts_by_line_and_column) {
    CHECK(contains(error_of(header + "6.35,3,300,1.0,7.0,2.0,0.02,6\n"),
                   ":2: column 'radial_width_mm': '7.0' is out of range; expected 1e-06 to 6.35"));
    CHECK(contains(error_of(header + "6.35,2.5,300,1.0,1.0,2.0,0.02,6\n"), ":2: column 'flutes': 2.5 is not whole"));
    CHECK(contains(error_of(header + "6.35,3,0,1.0,1.0,2.0,0.02,6\n"),
                   ":2: column 'spindle_rad_s': '0' is out of range"));
    CHECK(contains(error_of(header + "6.35,3,300,-1,1.0,2.0,0.02,6\n"),
                   ":2: column 'axial_depth_mm': '-1' is out of range"));
}
