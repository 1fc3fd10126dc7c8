// SPDX-License-Identifier: Apache-2.0
#include "calibration/roughness_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string header =
    "spindle_speed_rpm,feed_mm_rev,tool_diameter_mm,axial_depth_mm,feed_force_N,axial_force_N,Ra_um,Rz_um\n";

struct CuttingTest {
    double V, f, phi, D, ratio;
};

using Change = std::function<void(CuttingTest&)>;

/// The 36 combinations of the paper's Table 1 with both published models, 10 % of scatter. Each sixth surface is by
/// `odd` too rough or too smooth, in turn.
std::string published_tests(
    const Change& change = [](CuttingTest&) {}, unsigned seed = 1, double odd = 1.0) {
    std::mt19937 engine(seed);
    int number = 0;
    std::normal_distribution<double> normal(0.0, 1.0);
    std::ostringstream text;
    text.precision(12);
    text << header;
    for (const double V : {8000.0, 10000.0, 12000.0}) {
        for (const double f : {0.01, 0.03}) {
            for (const double phi : {4.0, 6.0, 8.0}) {
                for (const double D : {0.3, 0.5}) {
                    CuttingTest t{V, f, phi, D, std::exp(0.3 * normal(engine))};
                    change(t);
                    const double Ra = 7.5e-6 * std::pow(t.V, 0.964) * std::pow(t.f, 0.195) * std::pow(t.phi, 2.69) *
                                      std::pow(t.D, 0.917) * std::pow(t.ratio, -2.6) * std::exp(0.1 * normal(engine));
                    const double Rz = 2.91 * std::pow(t.V, 0.16) * std::pow(t.f, 0.438) * std::pow(t.phi, 1.25) *
                                      std::pow(t.D, 0.474) * std::pow(t.ratio, -2.84) * std::exp(0.1 * normal(engine));
                    ++number;
                    const double oddness = number % 12 == 0 ? odd : (number % 6 == 0 ? 1.0 / odd : 1.0);
                    text << t.V << ',' << t.f << ',' << t.phi << ',' << t.D << ',' << 20.0 * t.ratio << ",-20,"
                         << Ra * oddness << ',' << Rz * oddness << '\n';
                }
            }
        }
    }
    return text.str();
}

struct Run {
    int code = -1;
    std::string text;
    std::string error;
    std::string toml_text;
    toml::table toml;

    double value(const std::string& key) const { return toml["roughness"][key].value_or(std::nan("")); }
    void near(const std::string& key, double truth) const {
        DOUBLES_EQUAL(truth, value(key), 4.0 * value(key + "_se"));
    }
};

Run calibrate(const std::string& data, const std::string& measure = "", const std::vector<std::string>& held = {}) {
    const TemporaryFolder folder;
    RoughnessCalibrationOptions options;
    options.data = {folder.write("tests.csv", data)};
    options.output = folder.path("out.toml");
    options.measure = measure;
    options.held = held;
    Run run;
    std::ostringstream out;
    run.error = message_of<InputError>([&] { run.code = calibrate_roughness(options, out); });
    run.text = out.str();
    if (run.error.empty()) {
        run.toml_text = folder.read("out.toml");
        run.toml = toml::parse(run.toml_text);
    } else {
        LONGS_EQUAL(1, folder.file_count());
    }
    return run;
}

const std::string rest_of_tool =
    "[tool]\nteeth = 2\ndiameter_mm = 6\nflute_length_mm = 12\ntooth_force_limit_N = 200\n[cutting]\n"
    "k_s_N_per_mm2 = 1650\nk_1 = 0.376\n[control]\nentry_feed_per_tooth_mm = 0.005\n"
    "air_feed_per_tooth_mm = 0.005\nmax_feed_per_tooth_mm = 0.02\n";

millforce::firmware::Parameters<float> read_tool(const std::string& text) {
    const TemporaryFolder folder;
    return read_parameters(folder.write("machine.toml", "[spindle]\nK_t1_Nm_per_A = 0.7\n").string(),
                           folder.write("tool.toml", text).string());
}

}  // namespace

TEST_GROUP(RoughnessCalibration){};

TEST(RoughnessCalibration, of_the_published_conditions_finds_the_published_exponents_within_two_standard_errors) {
    const std::array<const char*, 5> keys{"spindle_speed_exponent", "feed_exponent", "tool_diameter_exponent",
                                          "axial_depth_exponent", "force_ratio_exponent"};
    const std::array<std::array<double, 5>, 2> published{
        {{0.964, 0.195, 2.69, 0.917, -2.6}, {0.16, 0.438, 1.25, 0.474, -2.84}}};
    for (const std::size_t model : {0U, 1U}) {
        int within = 0;
        for (unsigned seed = 1; seed <= 20; ++seed) {
            const Run run = calibrate(published_tests([](CuttingTest&) {}, seed), model == 0 ? "" : "Rz");
            STRCMP_EQUAL("", run.error.c_str());
            STRCMP_EQUAL(model == 0 ? "Ra" : "Rz", run.toml["roughness"]["measure"].value_or(""));
            DOUBLES_EQUAL(30.0, run.value("degrees_of_freedom"), 0.0);
            DOUBLES_EQUAL(0.1, run.value("residual_ln_sd"), 0.05);
            for (std::size_t j = 0; j < keys.size(); ++j) {
                const std::string key = keys[j];
                within += std::abs(run.value(key) - published[model][j]) <= 2.0 * run.value(key + "_se") ? 1 : 0;
            }
        }
        CHECK(within >= 88);  // of 100; 94.5 are to be expected
    }
}

TEST(RoughnessCalibration, writes_a_table_that_the_tool_file_takes_as_it_is) {
    const Run run = calibrate(published_tests());
    const auto parameters = read_tool(rest_of_tool + run.toml_text);
    const millforce::estimation::RoughnessPredictor<float> predictor(parameters.tool.roughness);
    const auto prediction = predictor.predict({10000.0F, 0.02F, 6.0F, 0.4F, 1.0F});
    CHECK(prediction.is_sure());
    const double truth =
        7.5e-6 * std::pow(1e4, 0.964) * std::pow(0.02, 0.195) * std::pow(6, 2.69) * std::pow(0.4, 0.917);
    DOUBLES_EQUAL(truth, static_cast<double>(prediction.roughness_um), 0.1 * truth);
    CHECK(prediction.high_um > 1.15F * prediction.roughness_um && prediction.high_um < 1.35F * prediction.roughness_um);
}

TEST(RoughnessCalibration, names_the_column_that_does_not_vary_and_holds_it_where_it_is_told_to) {
    const std::string data = published_tests([](CuttingTest& t) { t.phi = 6.0; });
    CHECK(
        contains(calibrate(data).error,
                 "'tool_diameter_exponent' cannot be determined: all tests have tool_diameter_mm of about 6; expected "
                 "tests at clearly different values, or --hold tool_diameter_mm"));
    const Run held = calibrate(data, "Ra", {"tool_diameter_mm"});
    LONGS_EQUAL(0, held.code);
    DOUBLES_EQUAL(0.0, held.value("tool_diameter_exponent"), 0.0);
    CHECK(contains(held.text, "held at tool_diameter_mm = 6"));
    held.near("force_ratio_exponent", -2.6);
    CHECK(contains(calibrate(data, "Ra", {"diameter"}).error, "--hold diameter: expected one of spindle_speed_rpm"));
}

TEST(RoughnessCalibration, names_the_columns_that_change_only_together) {
    const Run run = calibrate(published_tests([](CuttingTest& t) { t.D = 0.05 * t.phi; }));
    CHECK(contains(run.error,
                   "'tool_diameter_exponent' cannot be determined: tool_diameter_mm changes only along with "
                   "other columns, axial_depth_mm above all"));
}

TEST(RoughnessCalibration, refuses_too_few_tests) {
    const std::string all = published_tests();
    std::string few = header;
    std::istringstream lines(all);
    std::string line;
    for (int k = 0; std::getline(lines, line) && k <= 30; ++k) {
        few += k % 5 == 1 ? line + "\n" : "";
    }
    CHECK(contains(calibrate(few).error,
                   "'residual_ln_sd' cannot be determined: 6 tests with a measured roughness; expected at least 7"));
}

TEST(RoughnessCalibration, leaves_out_rows_without_a_measurement_and_points_at_the_odd_one) {
    std::string data = published_tests();
    data += "10000,0.02,6,0.4,20,-20,,\n";
    data += "10000,0.02,6,0.4,20,-20,50,\n";
    const Run run = calibrate(data);
    CHECK(contains(run.text, "37 tests"));
    CHECK(contains(run.text, "furthest off: "));
    CHECK(contains(run.text, "tests.csv:39, "));
}

TEST(RoughnessCalibration, takes_a_ratio_in_place_of_the_two_forces) {
    const std::string ratio_header =
        "force_ratio,spindle_speed_rpm,feed_mm_rev,tool_diameter_mm,axial_depth_mm,Rz_um\n";
    CHECK(contains(calibrate(ratio_header + "1,1000,0.1,6,0.3,2\n").error, "1 tests with a measured roughness"));
    CHECK(contains(calibrate(ratio_header + "0,1000,0.1,6,0.3,2\n").error, ":2: column 'force_ratio': '0' is out of"));
}

TEST(RoughnessCalibration, names_what_is_missing_or_wrong_in_the_file) {
    CHECK(contains(calibrate("feed_mm_rev\n").error, ":1: no column 'spindle_speed_rpm'"));
    CHECK(contains(calibrate("spindle_speed_rpm,feed_mm_rev,tool_diameter_mm,axial_depth_mm,Ra_um\n").error,
                   "no column 'feed_force_N', nor 'force_ratio'"));
    CHECK(contains(calibrate("spindle_speed_rpm,feed_mm_rev,tool_diameter_mm,axial_depth_mm,force_ratio\n").error,
                   "no column 'Rz_um', the measured roughness"));
    CHECK(contains(calibrate(header + "1000,0.1,6,0.3,0,-20,1,5\n").error, ":2: column 'feed_force_N': 0 N"));
    CHECK(contains(calibrate(header + "1000,-0.1,6,0.3,5,-20,1,5\n").error, ":2: column 'feed_mm_rev': '-0.1'"));
    CHECK(contains(calibrate(header + "1000,0.1,6,0.3,5,-20,0,5\n").error, ":2: column 'Ra_um': '0'"));
}

TEST(RoughnessCalibration, refuses_a_column_in_another_unit_by_the_tools_diameter_or_the_grades_of_roughness) {
    const auto error = [](const char* column, double factor) {
        return calibrate(scaled(published_tests(), column, factor)).error;
    };
    CHECK(
        contains(error("feed_mm_rev", 8000.0),
                 "tests.csv:2: column 'feed_mm_rev': 80 on a tool of Ø4 mm; expected a ten-thousandth of the diameter "
                 "to the diameter; is it in mm/min, mm/s or µm?"));
    CHECK(contains(error("feed_mm_rev", 1e-3), "is it in m or inch?"));
    CHECK(contains(error("axial_depth_mm", 1e3), "tests.csv:2: column 'axial_depth_mm': 300 on a tool of Ø4 mm"));
    CHECK(contains(error("axial_depth_mm", 1e-3), "is it in m?"));
    CHECK(contains(error("spindle_speed_rpm", 1e-3), "column 'spindle_speed_rpm': 8 on a tool of Ø4 mm"));
    CHECK(contains(error("axial_force_N", 1e-3), "times the axial one; expected 0.01 to 100; is one of them in kN?"));
    CHECK(contains(error("Ra_um", 1e-3), "column 'Ra_um': 0.00"));
    CHECK(contains(error("Ra_um", 1e-3), "grades of roughness go from 0.025 to 50 µm; is it in mm?"));
    STRCMP_EQUAL("", calibrate(published_tests()).error.c_str());
    LONGS_EQUAL(0, calibrate(published_tests()).code);
}

TEST(RoughnessCalibration, asks_about_speeds_that_are_round_only_in_another_unit_and_a_roughness_beyond_the_grades) {
    const auto asked = [](const char* column, double factor, const char* measure = "Ra") {
        const Run run = calibrate(scaled(published_tests(), column, factor), measure);
        LONGS_EQUAL(1, run.code);
        return run.text;
    };
    CHECK(contains(asked("spindle_speed_rpm", 0.104719755), "1256.6 rad/s being 12000 1/min; is it in rad/s?"));
    CHECK(contains(asked("spindle_speed_rpm", 1.0 / 60.0), "200 1/s being 12000 1/min; is it in 1/s?"));
    CHECK(contains(asked("Ra_um", 100.0), "grades of roughness go from 0.025 to 50 µm; is it in nm or µinch?"));
    CHECK(contains(asked("Rz_um", 1e-3, "Rz"), "grades of roughness go from 0.1 to 200 µm; is it in mm?"));
    CHECK(contains(asked("feed_mm_rev", 100.0), "usual is less than 1.8; is it in mm/s?"));
    CHECK(contains(asked("tool_diameter_mm", 0.1), "Ø0.6 at 10000 1/min (medians) cuts at 18.8 m/min"));
}

TEST(RoughnessCalibration, ends_with_1_where_left_out_tests_fall_outside_their_intervals) {
    LONGS_EQUAL(0, calibrate(published_tests()).code);
    const Run broken = calibrate(published_tests([](CuttingTest&) {}, 1, 20.0));
    LONGS_EQUAL(1, broken.code);
    CHECK(contains(broken.text, "bound 85 %: BROKEN"));
    CHECK(!broken.toml_text.empty());
}

TEST(RoughnessCalibration, limit_of_R_a_is_refused_where_the_tool_has_no_model_of_it_with_an_interval) {
    const std::string limited = rest_of_tool + "Ra_limit_um = 1.6\n";
    const auto error_of = [](const std::string& text) { return message_of<InputError>([&] { read_tool(text); }); };
    CHECK(contains(error_of(limited), "control.Ra_limit_um = 1.6: the file has no model of R_a with an interval"));
    CHECK(contains(error_of(limited + "[roughness]\nconstant_um = 7.5e-6\n"), "no model of R_a with an interval"));
    CHECK(contains(error_of(limited + calibrate(published_tests(), "Rz").toml_text), "no model of R_a"));
    STRCMP_EQUAL("", error_of(limited + calibrate(published_tests()).toml_text).c_str());
}

TEST(RoughnessCalibration, counts_a_repeated_row_once_and_says_so) {
    const std::string rows = published_tests();
    const Run once = calibrate(rows);
    const Run twice = calibrate(rows + rows.substr(header.size()));
    DOUBLES_EQUAL(once.value("feed_exponent_se"), twice.value("feed_exponent_se"), 0.0);
    CHECK(contains(twice.text, "36 rows repeat an earlier row exactly"));
}
