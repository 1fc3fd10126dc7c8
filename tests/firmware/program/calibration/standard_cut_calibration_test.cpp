// SPDX-License-Identifier: Apache-2.0
#include "calibration/standard_cut_calibration.hpp"
#include "calibration/cutting_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>
#include <vector>

using namespace millforce::host;
using namespace millforce::test;
using millforce::estimation::CutSide;

namespace {

constexpr const char* machine_toml = R"(
[spindle]
K_t1_Nm_per_A = 0.7
gain_relative_sd = 0.01
[x]
K_x2_positive_A_min_per_m = 0.6
K_x3_A = 1.6
K_x4_N_per_A = 120.0
gain_relative_sd = 0.01
)";

constexpr const char* library_toml = R"(
[[coefficients]]
name = "carbide"
k_s_N_per_mm2 = 1007.59
p_s = -0.2557
k_1 = 0.2242
p_1 = -0.1546
K_s_relative_sd = 0.05
[[coefficients]]
name = "HSS"
k_s_N_per_mm2 = 831.16
p_s = -0.2749
k_1 = 0.1526
p_1 = -0.2227
)";

struct Cut {
    double feed_mm_min;
    double width_mm;
};

const std::vector<Cut> seven_cuts{{100, 0.8}, {175, 0.8}, {250, 0.8}, {400, 0.8}, {700, 0.8}, {250, 0.4}, {250, 1.6}};

/// A recording of running in air and a cut in turn, 2 s each at 100 Hz, and its table of cuts.
struct Recorded {
    std::string recording = "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n";
    std::string table = "start_s,end_s,tool_diameter_mm,flutes,axial_depth_mm,radial_width_mm\n";
};

Recorded record(const millforce::estimation::CuttingLaw<double>& law, const std::vector<Cut>& cuts,
                bool with_air = true, double speed_scale = 1.0) {
    const double speed_rad_s = speed_scale * 1260.0 * 2.0 * std::numbers::pi / 60.0;
    std::mt19937 generator(5);
    std::normal_distribution<double> noise(0.0, 0.02);
    Recorded result;
    double t = 0.0;
    for (const Cut& cut : cuts) {
        for (const double width :
             with_air ? std::vector<double>{0.0, cut.width_mm} : std::vector<double>{cut.width_mm}) {
            const double f_z = cut.feed_mm_min / (4.0 * 1260.0);
            const auto forces = millforce::estimation::average_forces<double>(
                law, {f_z, width > 0.0 ? 12.0 : 0.0,
                      millforce::estimation::engagement_angles(CutSide::down, width / 4.0), 4.0});
            const double torque_Nm = forces.tangential_N * 0.004;
            const double w = cut.feed_mm_min / 1000.0;
            result.table += fmt::format("{:.3f},{:.3f},8,4,{},{}\n", t - 0.005, t + 1.994, width > 0.0 ? 12 : 0, width);
            for (int k = 0; k < 200; ++k, t += 0.01) {
                result.recording += fmt::format(
                    "{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}\n", t,
                    speed_scale == 1.0 ? std::fmod(t * speed_rad_s, 2.0 * std::numbers::pi) : t * speed_rad_s,
                    (torque_Nm + 0.6) / 0.65 + noise(generator),
                    1.6 + 0.6 * w + forces.feed_N / 110.0 + noise(generator), w / 0.06);
            }
        }
    }
    return result;
}

struct Ended {
    int code = -1;
    std::string error;
    std::string text;
    toml::table toml;
};

Ended standard_cut(const Recorded& recorded, const std::string& entry = "carbide") {
    const TemporaryFolder folder;
    StandardCutOptions options;
    options.data = {folder.write("recording.csv", recorded.recording)};
    options.cuts = folder.write("cuts.csv", recorded.table);
    options.machine = folder.write("machine.toml", machine_toml);
    options.database = folder.write("library.toml", library_toml);
    options.entry = entry;
    options.output = folder.path("out.toml");
    std::ostringstream out;
    Ended ended;
    ended.error = message_of<InputError>([&] { ended.code = calibrate_standard_cut(options, out); });
    ended.text = out.str();
    if (ended.error.empty()) {
        ended.toml = toml::parse(folder.read("out.toml"));
    } else {
        LONGS_EQUAL(4, folder.file_count());
    }
    return ended;
}

void refuses(const Ended& ended, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        CHECK_TEXT(ended.error.find(part) != std::string::npos, (part + " not in: " + ended.error).c_str());
    }
    LONGS_EQUAL(0, std::count(ended.error.begin(), ended.error.end(), '\n'));
}

millforce::estimation::CuttingLaw<double> carbide() {
    millforce::estimation::CuttingLaw<double> law;
    law.k_s_N_per_mm2 = 1007.59;
    law.p_s = -0.2557;
    law.k_1 = 0.2242;
    law.p_1 = -0.1546;
    return law;
}

}  // namespace

TEST_GROUP(StandardCutCalibration){
    void within(const Ended& ended, const char* table, const std::string& key,
                double truth){const double value = ended.toml[table][key].value_or(std::nan(""));
const double error = ended.toml[table][key + "_se"].value_or(std::nan(""));
DOUBLES_EQUAL(truth, value, 4.0 * error);
CHECK(error < 0.03 * std::abs(truth) + 0.2);
}
}
;

TEST(StandardCutCalibration, finds_the_gains_of_both_drives) {
    const Ended ended = standard_cut(record(carbide(), seven_cuts));
    STRCMP_EQUAL("", ended.error.c_str());
    within(ended, "spindle", "K_t1_Nm_per_A", 0.65);
    within(ended, "spindle", "K_t2_Nm", -0.6);
    within(ended, "x", "K_x4_N_per_A", 110.0);
}

TEST(StandardCutCalibration, K_x5_that_is_smaller_than_its_error_is_neither_fitted_nor_written) {
    int left_out = 0;
    for (std::size_t turns = 0; turns < seven_cuts.size(); ++turns) {
        std::vector<Cut> cuts = seven_cuts;  // in another order each cut has other noise
        std::rotate(cuts.begin(), cuts.begin() + static_cast<std::ptrdiff_t>(turns), cuts.end());
        const Ended ended = standard_cut(record(carbide(), cuts));
        const toml::table& x = *ended.toml["x"].as_table();
        if (x.contains("K_x5_N_m_per_min")) {
            CHECK(x["K_x5_N_m_per_min_se"].value_or(1e9) < std::abs(x["K_x5_N_m_per_min"].value_or(0.0)));
            continue;
        }
        ++left_out;
        CHECK(!x.contains("K_x5_N_m_per_min_se"));
        CHECK(ended.text.find("not determined by these data; fitted without it, not written") != std::string::npos);
        within(ended, "x", "K_x4_N_per_A", 110.0);
    }
    CHECK(left_out >= 2);
}

TEST(StandardCutCalibration, the_databases_doubt_is_the_gains_doubt) {
    const Ended ended = standard_cut(record(carbide(), seven_cuts));
    DOUBLES_EQUAL(0.05, ended.toml["spindle"]["gain_relative_sd"].value_or(0.0), 0.002);
    CHECK(ended.toml["x"]["gain_relative_sd"].value_or(0.0) >= 0.05);
}

TEST(StandardCutCalibration, refuses_and_names_the_missing_cut) {
    refuses(standard_cut(record(carbide(), {{250, 0.8}, {250, 0.8}, {250, 0.8}})),
            {"cuts.csv", "'K_t1_Nm_per_A'", "about the same force", "twice the radial width"});
    refuses(standard_cut(record(carbide(), {{250, 0.4}, {250, 0.8}, {250, 1.6}})),
            {"cuts.csv", "'x.K_x5_N_m_per_min'", "same feed", "twice or half the feed"});
    refuses(standard_cut(record(carbide(), seven_cuts, false)), {"'K_t2_Nm'", "no row in air"});
    refuses(standard_cut(record(carbide(), {{250, 0.0}, {400, 0.0}})), {"'K_t1_Nm_per_A'", "no cut"});
}

TEST(StandardCutCalibration, refuses_tables_that_do_not_fit_the_recording) {
    Recorded recorded = record(carbide(), seven_cuts);
    recorded.table += "500,501,8,4,12,0.8\n";
    refuses(standard_cut(recorded), {"cuts.csv:16", "0 samples"});
    recorded = record(carbide(), seven_cuts);
    recorded.table += "1,3,8,4,12,0.8\n5,6.8,8,4.5,12,0.8\n";
    refuses(standard_cut(recorded), {"cuts.csv:17", "'flutes'", "4.5"});
    recorded = record(carbide(), {{100, 0.8}, {700, 0.8}});
    recorded.table += "3,5,8,4,12,0.8\n";
    refuses(standard_cut(recorded), {"cuts.csv:6", "steady feed"});
}

TEST(StandardCutCalibration, refuses_feeds_below_the_velocity_floor) {
    refuses(standard_cut(record(carbide(), {{50, 0.8}, {250, 0.8}, {250, 1.6}})),
            {"cuts.csv:2", "near rest", "x.velocity_floor_mm_s = 1"});
}

TEST(StandardCutCalibration, refuses_an_angle_or_a_feed_in_another_unit_by_its_chip) {
    const auto with_scaled = [](const char* column, double factor) {
        Recorded recorded = record(carbide(), seven_cuts);
        recorded.recording = scaled(recorded.recording, column, factor);
        return standard_cut(recorded);
    };
    refuses(with_scaled("x_velocity_mm_s", 60.0),
            {"cuts.csv:2: column 'x_velocity_mm_s': 100 mm/s is a chip of 1.19 mm", "x_velocity_mm_s in mm/min?"});
    Recorded recorded = record(carbide(), seven_cuts, true, 57.29578);
    refuses(standard_cut(recorded), {"cuts.csv:2", "is a chip of 0.346 µm on a tool of Ø8 mm; expected at least 0.8 µm",
                                     "is spindle_angle_rad in degrees"});
}

TEST(StandardCutCalibration, asks_about_a_depth_or_width_in_cm_by_gains_that_are_far_from_the_machines) {
    LONGS_EQUAL(0, standard_cut(record(carbide(), seven_cuts)).code);
    for (const char* column : {"axial_depth_mm", "radial_width_mm"}) {
        Recorded recorded = record(carbide(), seven_cuts);
        recorded.table = scaled(recorded.table, column, 0.1);
        const Ended ended = standard_cut(recorded);
        STRCMP_EQUAL("", ended.error.c_str());
        LONGS_EQUAL(1, ended.code);
        CHECK(contains(ended.text, "warning: 'K_t1_Nm_per_A' = 0.0"));
        CHECK(contains(ended.text,
                       "and the machine's file has 0.7; usual is a third to three times that; are "
                       "axial_depth_mm or radial_width_mm in cm"));
        CHECK(contains(ended.text, "warning: 'x.K_x4_N_per_A' = "));
    }
}

TEST(StandardCutCalibration, lists_the_entries_of_the_database) {
    refuses(standard_cut(record(carbide(), seven_cuts), ""), {"library.toml", "--entry", "carbide, HSS"});
    refuses(standard_cut(record(carbide(), seven_cuts), "steel"), {"library.toml", "'steel'", "carbide, HSS"});
}

TEST_GROUP(CurrentCuttingCalibration){
    Ended cutting(const Recorded& recorded, bool with_machine = true){const TemporaryFolder folder;
CuttingCalibrationOptions options;
options.data = {folder.write("recording.csv", recorded.recording)};
options.cuts = folder.write("cuts.csv", recorded.table);
std::string machine = machine_toml;
machine.replace(machine.find("0.7"), 3, "0.65");
machine.replace(machine.find("120.0"), 5, "110.0");
if (with_machine) {
    options.machine = folder.write("machine.toml", machine);
}
options.output = folder.path("out.toml");
std::ostringstream out;
Ended ended;
ended.error = message_of<InputError>([&] { calibrate_cutting(options, out); });
if (ended.error.empty()) {
    ended.toml = toml::parse(folder.read("out.toml"));
}
return ended;
}
}
;

TEST(CurrentCuttingCalibration, finds_the_law_from_currents_alone) {
    std::vector<Cut> cuts = seven_cuts;
    cuts.insert(cuts.end(), {{100, 0.4}, {700, 0.4}, {700, 2.0}});
    const Ended ended = cutting(record(carbide(), cuts));
    STRCMP_EQUAL("", ended.error.c_str());
    const auto check = [&](const std::string& key, double truth) {
        const double error = ended.toml["cutting"][key + "_se"].value_or(std::nan(""));
        DOUBLES_EQUAL(truth, ended.toml["cutting"][key].value_or(std::nan("")), 4.0 * error);
        CHECK(error < 0.1 * std::abs(truth));
    };
    check("k_s_N_per_mm2", 1007.59);
    check("p_s", -0.2557);
    check("k_1", 0.2242);
    check("p_1", -0.1546);
}

TEST(CurrentCuttingCalibration, refuses_what_currents_cannot_tell) {
    refuses(cutting(record(carbide(), seven_cuts, false)), {"cuts.csv:2", "idle torque", "in air"});
    refuses(cutting(record(carbide(), {{250, 0.0}, {400, 0.0}})), {"'k_s_N_per_mm2'", "no cut"});
    refuses(cutting(record(carbide(), {{250, 0.8}, {250, 0.8}, {250, 0.8}, {250, 0.8}})), {"'p_s'", "second feed"});
    refuses(cutting(record(carbide(), seven_cuts), false), {"--machine"});
}
