// SPDX-License-Identifier: Apache-2.0
#include "calibration/recorded_cuts.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string table_header = "recording,start_s,end_s,tool_diameter_mm,flutes,axial_depth_mm,radial_width_mm\n";
const std::string recording_header =
    "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s,y_current_A,y_velocity_mm_s\n";

struct Motion {
    double spindle_rad_s = 100.0;
    double x_mm_s = 5.0;
    double y_mm_s = 0.0;
    double x_at_end_mm_s = 5.0;
};

/// One second at 100 Hz, a whole turn every 0.0628 s.
std::string recording_of(const Motion& motion) {
    std::string text = recording_header;
    for (int k = 0; k < 100; ++k) {
        const double x_mm_s = k < 80 ? motion.x_mm_s : motion.x_at_end_mm_s;
        text += fmt::format("{:.2f},{:.5f},3,2,{},1,{}\n", 0.01 * k, 0.01 * k * motion.spindle_rad_s, x_mm_s,
                            motion.y_mm_s);
    }
    return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_GROUP(RecordedCuts) {
    TemporaryFolder folder;

    std::vector<RecordedStretch> read(const std::string& rows, const std::string& text) {
        return read_recorded_cuts({folder.write("a.csv", text)}, folder.write("cuts.csv", table_header + rows));
    }
    std::string error_of(const std::string& rows, const std::string& text) {
        return message_of<InputError>([&] { read(rows, text); });
    }
    std::string table_error(const std::string& rows, std::size_t recordings = 1) {
        const auto table = folder.write("cuts.csv", table_header + rows);
        const std::vector<std::filesystem::path> all{folder.path("a.csv"), folder.path("b.csv")};
        return message_of<InputError>([&] {
            static_cast<void>(read_cut_table(table, {all.begin(), all.begin() + static_cast<int>(recordings)}));
        });
    }
};

TEST(RecordedCuts, are_averaged_between_their_times_whether_named_by_file_or_by_path) {
    for (const std::string& name : {std::string("a.csv"), folder.path("a.csv").string(), std::string()}) {
        const auto stretches = read(name + ",0.1,0.9,10,4,2,5\n", recording_of({}));
        LONGS_EQUAL(1, stretches.size());
        DOUBLES_EQUAL(100.0, stretches[0].spindle_rad_s, 0.01);
        DOUBLES_EQUAL(5.0, stretches[0].feed_mm_s, 1e-9);
        DOUBLES_EQUAL(0.8, stretches[0].duration_s, 0.011);
        LONGS_EQUAL(0, stretches[0].axis);
    }
}

TEST(RecordedCuts, take_the_axis_that_feeds) {
    const auto stretches =
        read("a.csv,0,0.9,10,4,2,5\n", recording_of({.x_mm_s = 0.0, .y_mm_s = -4.0, .x_at_end_mm_s = 0.0}));
    LONGS_EQUAL(1, stretches[0].axis);
    DOUBLES_EQUAL(-4.0, stretches[0].feed_mm_s, 1e-9);
}

TEST(RecordedCuts, are_refused_where_the_motion_is_not_one_steady_feed) {
    const std::string cut = "a.csv,0,0.99,10,4,2,5\n";
    STRCMP_CONTAINS("cuts.csv:2: no axis moves from 0 to 0.99 s; expected a steady feed",
                    error_of(cut, recording_of({.x_mm_s = 0.0, .x_at_end_mm_s = 0.0})).c_str());
    STRCMP_CONTAINS("cuts.csv:2: x and y both move from 0 to 0.99 s; expected a feed along one axis",
                    error_of(cut, recording_of({.y_mm_s = 1.0})).c_str());
    STRCMP_CONTAINS("cuts.csv:2: the spindle turns at 0.5 rad/s",
                    error_of(cut, recording_of({.spindle_rad_s = 0.5})).c_str());
    STRCMP_CONTAINS("cuts.csv:2: x feeds at", error_of(cut, recording_of({.x_at_end_mm_s = 3.0})).c_str());
    STRCMP_CONTAINS("cuts.csv:2: 11 samples from 0 to 0.1 s of the recording; expected at least 20",
                    error_of("a.csv,0,0.1,10,4,2,5\n", recording_of({})).c_str());
}

TEST(RecordedCuts, pass_over_samples_without_an_angle_or_a_current) {
    const std::string whole = recording_of({});
    std::string text = replaced(whole, "0.50,50.00000,3,", "0.50,,3,");
    text = replaced(text, "0.60,60.00000,3,", "0.60,60.00000,,");
    const auto stretches = read("a.csv,0.1,0.9,10,4,2,5\n", text);
    DOUBLES_EQUAL(100.0, stretches[0].spindle_rad_s, 0.01);
    DOUBLES_EQUAL(3.0, stretches[0].spindle_current_A, 1e-9);
}

TEST(RecordedCuts, need_a_time_that_grows_and_the_columns_of_an_axis) {
    const std::string cut = "a.csv,0,0.99,10,4,2,5\n";
    STRCMP_CONTAINS("a.csv:4: column 'time_s': 0.01 s after 0.01 s; expected time to grow",
                    error_of(cut, recording_header + "0,0,3,2,5,1,0\n0.01,1,3,2,5,1,0\n0.01,2,3,2,5,1,0\n").c_str());
    STRCMP_CONTAINS("the feed force comes from it",
                    error_of(cut, "time_s,spindle_angle_rad,spindle_current_A,y_current_A\n0,0,3,2\n").c_str());
}

TEST(RecordedCuts, of_a_table_name_a_recording_that_is_given) {
    STRCMP_EQUAL("", table_error(",0,1,10,4,2,5\n").c_str());
    STRCMP_CONTAINS("cuts.csv:2: column 'recording': empty; expected the name of one of the 2 recordings",
                    table_error(",0,1,10,4,2,5\n", 2).c_str());
    STRCMP_EQUAL("", table_error("b.csv,0,1,10,4,2,5\n", 2).c_str());
    STRCMP_CONTAINS("column 'recording': 'c.csv' is none of the recordings given",
                    table_error("c.csv,0,1,10,4,2,5\n", 2).c_str());
}

TEST(RecordedCuts, of_a_table_are_refused_where_a_row_is_wrong_repeated_or_missing) {
    STRCMP_CONTAINS("no row; expected one for each cut", table_error("").c_str());
    STRCMP_CONTAINS("the row repeats an earlier one", table_error("a.csv,0,1,10,4,2,5\na.csv,0,1,10,4,2,5\n").c_str());
    STRCMP_CONTAINS("3.5 is not whole; expected a number of flutes", table_error("a.csv,0,1,10,3.5,2,5\n").c_str());
    STRCMP_CONTAINS("'12' is out of range", table_error("a.csv,0,1,10,4,2,12\n").c_str());
    STRCMP_EQUAL("", table_error("a.csv,0,1,10,4,,\n").c_str());  // in air
}
