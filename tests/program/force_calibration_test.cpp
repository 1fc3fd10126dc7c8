// SPDX-License-Identifier: Apache-2.0
#include "csv_rows.hpp"
#include "force_recordings.hpp"
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

/// The tool without its law, its place in the holder not known.
std::string without(const std::string& text, const std::string& table) {
    return text.substr(0, text.find("[" + table + "]"));
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
