// SPDX-License-Identifier: Apache-2.0
#include "csv_rows.hpp"
#include "firmware/program/calibration/scaled_column.hpp"
#include "force_recordings.hpp"
#include "inputs.hpp"

#include <filesystem>
#include <sstream>

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

/// The tool without its law, its place in the holder not known.
std::string without(const std::string& text, const std::string& table) {
    return text.substr(0, text.find("[" + table + "]"));
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) {
        cells.push_back(cell);
    }
    return cells;
}

/// The number with this sign before it: "-" turns it.
std::string negated(const std::string& cell, const std::string& sign) {
    return sign.empty() || cell.starts_with('-') ? (sign.empty() ? cell : cell.substr(1)) : sign + cell;
}

constexpr const char* cut_columns = "recording,start_s,end_s,tool_diameter_mm,flutes,axial_depth_mm,radial_width_mm\n";

}  // namespace

TEST_GROUP(ForceCalibration) {
    Inputs inputs;

    /// Three widths at as many feeds, each a recording of its own.
    std::vector<std::string> face_mill_cuts(const std::vector<double>& feeds_mm) {
        std::string table = cut_columns;
        std::vector<std::string> files;
        for (const double feed_mm : feeds_mm) {
            for (const double immersion : {0.3, 0.5, 0.7}) {
                const std::string name = "cut_" + std::to_string(files.size()) + ".csv";
                inputs.write(name, face_mill_recording(immersion, 0.0, feed_mm));
                files.push_back(inputs.path(name).string());
                table += name + ",0,10,100,3,1.5," + std::to_string(50.0 * immersion) + "\n";
            }
        }
        inputs.write("cuts.csv", table);
        return files;
    }
    /// The same column of all files times the factor.
    void scale(const std::vector<std::string>& files, const std::string& column, double factor) {
        for (const std::string& file : files) {
            const auto name = std::filesystem::path(file).filename().string();
            inputs.write(name.c_str(), scaled(inputs.read(name.c_str()), column, factor));
        }
    }
    void scale_forces(const std::vector<std::string>& files, double factor) {
        scale(files, "fx_N", factor);
        scale(files, "fy_N", factor);
    }
    Ended calibrate(const std::string& what, std::vector<std::string> files) {
        std::vector<std::string> words{"calibrate", what};
        words.insert(words.end(), files.begin(), files.end());
        for (const std::string& word :
             {std::string("--cuts"), inputs.name("cuts.csv"), std::string("--machine"), inputs.name("machine.toml"),
              std::string("--tool"), inputs.name("tool.toml"), std::string("-o"), inputs.name("law.toml")}) {
            words.push_back(word);
        }
        return run_millforce(words);
    }
};

TEST(ForceCalibration, a_law_from_known_cuts_estimates_a_cut_that_it_has_not_seen) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const Ended ended = calibrate("force-drop", face_mill_cuts({0.1, 0.15, 0.2}));
    LONGS_EQUAL(0, ended.exit_code);
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop") + inputs.read("law.toml"));
    inputs.write("log.csv", face_mill_recording(0.4, 0.0));
    LONGS_EQUAL(0, inputs.replay().exit_code);
    int estimates = 0;
    for (const CsvRow& row : csv_rows(inputs.read("out.csv"))) {
        if (!row.at("force_drop_immersion").empty()) {
            DOUBLES_EQUAL(0.4, std::atof(row.at("force_drop_immersion").c_str()), 0.04);
            ++estimates;
        }
    }
    CHECK(estimates > 100);
}

TEST(ForceCalibration, cuts_of_one_feed_do_not_tell_edge_from_chip) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const Ended ended = calibrate("force-drop", face_mill_cuts({0.15}));
    STRCMP_EQUAL("", not_refused(ended, {"cuts.csv", "e_t_mm", "factor of 1.5"}).c_str());
    CHECK(!std::filesystem::exists(inputs.path("law.toml")));
}

TEST(ForceCalibration, a_law_is_not_used_below_the_narrowest_of_its_cuts) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    LONGS_EQUAL(0, calibrate("force-drop", face_mill_cuts({0.1, 0.2})).exit_code);
    CHECK(contains(inputs.read("law.toml"), "smallest_immersion = 0.3"));
}

TEST(ForceCalibration, two_cuts_are_too_few) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    inputs.write("a.csv", face_mill_recording(0.3, 0.0, 0.1));
    inputs.write("b.csv", face_mill_recording(0.5, 0.0, 0.2));
    inputs.write("cuts.csv", std::string(cut_columns) + "a.csv,0,10,100,3,1.5,15\nb.csv,0,10,100,3,1.5,25\n");
    STRCMP_EQUAL("", not_refused(calibrate("force-drop", {inputs.name("a.csv"), inputs.name("b.csv")}),
                                 {"cuts.csv", "2 cuts", "at least 4"})
                         .c_str());
}

TEST(ForceCalibration, a_sensor_with_swapped_or_reversed_axes_is_refused) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const auto files = face_mill_cuts({0.1, 0.2});
    const std::string right = "fx_N,fy_N";
    const auto with_columns = [&](const std::string& columns, const std::string& sign_x, const std::string& sign_y) {
        for (const std::string& file : files) {
            const auto name = std::filesystem::path(file).filename().string();
            std::istringstream rows(inputs.read(name.c_str()));
            std::ostringstream turned;
            std::string line;
            std::getline(rows, line);
            turned << with(line, right, columns) << '\n';
            while (std::getline(rows, line)) {
                const auto cells = cells_of(line);
                turned << cells[0] << ',' << cells[1] << ',' << negated(cells[2], sign_x) << ','
                       << negated(cells[3], sign_y) << ',' << cells[4] << ',' << cells[5] << '\n';
            }
            inputs.write(("turned_" + name).c_str(), turned.str());
        }
        std::vector<std::string> all;
        std::string table = inputs.read("cuts.csv");
        for (const std::string& file : files) {
            const auto name = std::filesystem::path(file).filename().string();
            all.push_back(inputs.name(("turned_" + name).c_str()));
            if (table.find("turned_" + name) == std::string::npos) {
                table = with(table, "\n" + name, "\nturned_" + name);
            }
        }
        inputs.write("cuts.csv", table);
        return calibrate("force-drop", all);
    };
    STRCMP_EQUAL("", not_refused(with_columns("fy_N,fx_N", "", ""), {"cuts.csv", "swapped"}).c_str());
    STRCMP_EQUAL("", not_refused(with_columns("fx_N,fy_N", "-", ""), {"cuts.csv", "reversed"}).c_str());
    STRCMP_EQUAL("", not_refused(with_columns("fx_N,fy_N", "", "-"), {"cuts.csv", "reversed"}).c_str());
    STRCMP_EQUAL("", not_refused(with_columns("fx_N,fy_N", "-", "-"), {"cuts.csv"}).c_str());
}

TEST(ForceCalibration, a_stretch_in_air_shows_no_drop) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    std::vector<FeedFrameSample> still(5000);
    for (std::size_t k = 0; k < still.size(); ++k) {
        still[k].turned_rad = 2.0 * std::numbers::pi * static_cast<double>(k) / 512.0;
    }
    inputs.write("air.csv", force_recording(still, 2560.0, 2.25, 0.0));
    inputs.write("cuts.csv", std::string(cut_columns) + "air.csv,0,10,100,3,1.5,25\n");
    STRCMP_EQUAL(
        "", not_refused(calibrate("force-drop", {inputs.name("air.csv")}), {"cuts.csv:2", "no force drop"}).c_str());
}

TEST(ForceCalibration, forces_in_another_unit_contradict_the_tools_law) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const auto files = face_mill_cuts({0.1, 0.2});
    LONGS_EQUAL(0, calibrate("force-drop", files).exit_code);
    scale_forces(files, 0.1);  // daN
    const Ended in_daN = calibrate("force-drop", files);
    LONGS_EQUAL(1, in_daN.exit_code);
    STRCMP_CONTAINS("warning: the forces of the cuts are 0.1", in_daN.out.c_str());
    STRCMP_CONTAINS("are the forces in kN, daN or mN, or axial_depth_mm", in_daN.out.c_str());
    scale_forces(files, 0.01);  // kN
    STRCMP_EQUAL("", not_refused(calibrate("force-drop", files),
                                 {"cuts.csv: the forces of the cuts are 0.001", "N/mm²", "expected 10 to 15000", "kN"})
                         .c_str());
}

TEST(ForceCalibration, a_depth_of_a_cut_in_cm_contradicts_the_tools_law) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const auto files = face_mill_cuts({0.1, 0.2});
    inputs.write("cuts.csv", scaled(inputs.read("cuts.csv"), "axial_depth_mm", 0.1));
    STRCMP_EQUAL("", not_refused(calibrate("force-drop", files), {"cuts.csv: the forces of the cuts are 16 times",
                                                                  "axial_depth_mm or radial_width_mm in another unit?"})
                         .c_str());
}

TEST(ForceCalibration, a_feed_an_angle_or_a_time_in_another_unit_is_refused_by_chip_and_cutting_speed) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    const auto not_refused_with = [&](const std::string& column, double factor, const std::vector<std::string>& parts) {
        inputs.write("log.csv", face_mill_recording(0.4, 0.0));
        inputs.write("cuts.csv", std::string(cut_columns) + "log.csv,0,10000,100,3,1.5,20\n");
        scale({inputs.name("log.csv")}, column, factor);
        return not_refused(calibrate("force-drop", {inputs.name("log.csv")}), parts);
    };
    const std::string in_mm_min = not_refused_with(
        "x_velocity_mm_s", 60.0, {"cuts.csv:2: column 'x_velocity_mm_s'", "a chip of 9 mm", "mm/min?"});
    STRCMP_EQUAL("", in_mm_min.c_str());
    const std::string in_degrees = not_refused_with("spindle_angle_rad", 180.0 / std::numbers::pi,
                                                    {"cuts.csv:2", "a chip of 2.62 µm", "in degrees"});
    STRCMP_EQUAL("", in_degrees.c_str());
    const std::string in_ms =
        not_refused_with("time_s", 1000.0, {"cuts.csv:2", "0.00157 m/s on a tool of Ø100 mm", "in ms?"});
    STRCMP_EQUAL("", in_ms.c_str());
}

TEST(ForceCalibration, one_force_of_two_in_another_unit_is_asked_about_and_another_feed_than_the_tools_refused) {
    inputs.write("tool.toml", end_mill_tool_text);
    inputs.write("known.csv", end_mill_recording(0.0, 0.0, 0.0));
    inputs.write("cuts.csv", std::string(cut_columns) + "known.csv,0,100,19.05,4,7.62,7.62\n");
    const std::string sound = inputs.read("known.csv");
    scale({inputs.name("known.csv")}, "fx_N", 1e-3);
    const Ended in_kN = calibrate("tip-angle", {inputs.name("known.csv")});
    LONGS_EQUAL(1, in_kN.exit_code);
    STRCMP_CONTAINS("warning: along the feed the force is 0.000", in_kN.out.c_str());
    STRCMP_CONTAINS("is fx_N or fy_N in kN, daN or mN?", in_kN.out.c_str());
    inputs.write("known.csv", scaled(sound, "x_velocity_mm_s", 0.06));
    STRCMP_EQUAL("", not_refused(calibrate("tip-angle", {inputs.name("known.csv")}),
                                 {"cuts.csv:2: 0.00229 mm per tooth, and [depth_shape] of the tool's file has 0.0381",
                                  "is a velocity in m/min"})
                         .c_str());
}

TEST(ForceCalibration, another_tools_cut_is_refused) {
    inputs.write("tool.toml", without(face_mill_tool_text, "force_drop"));
    inputs.write("log.csv", face_mill_recording(0.4, 0.0));
    inputs.write("cuts.csv", std::string(cut_columns) + "log.csv,0,10,80,3,1.5,25\n");
    STRCMP_EQUAL("", not_refused(calibrate("force-drop", {inputs.name("log.csv")}), {"cuts.csv:2", "100"}).c_str());
}

TEST(ForceCalibration, the_tips_angle_learnt_from_one_cut_lets_the_next_one_tell_its_width) {
    inputs.write("tool.toml", end_mill_tool_text);
    inputs.write("known.csv", end_mill_recording(0.0, 0.0, 0.0));
    inputs.write("cuts.csv", std::string(cut_columns) + "known.csv,0,100,19.05,4,7.62,7.62\n");
    LONGS_EQUAL(0, calibrate("tip-angle", {inputs.name("known.csv")}).exit_code);
    const std::string learnt = inputs.read("law.toml");
    inputs.write("tool.toml", end_mill_tool_text + learnt.substr(learnt.find("tip_angle_deg")));
    inputs.write("log.csv", end_mill_recording(-20.0, 10.0, 0.0));
    LONGS_EQUAL(0, inputs.replay().exit_code);
    int estimates = 0;
    for (const CsvRow& row : csv_rows(inputs.read("out.csv"))) {
        if (!row.at("depth_shape_radial_variation_percent").empty()) {
            DOUBLES_EQUAL(10.0, std::atof(row.at("depth_shape_radial_variation_percent").c_str()), 4.0);
            ++estimates;
        }
    }
    CHECK(estimates > 50);
}
