// SPDX-License-Identifier: Apache-2.0
#include "csv_rows.hpp"
#include "force_recordings.hpp"
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

constexpr double along_x = 0.0;
constexpr double to_the_left_and_back = 2.2;  // rad

double number(const std::string& cell) {
    return cell.empty() ? std::numeric_limits<double>::quiet_NaN() : std::atof(cell.c_str());
}

/// The recording with its angle, the second column, in 0…2π.
std::string wrapped_angles(const std::string& recording) {
    std::istringstream in(recording);
    std::ostringstream out;
    out.precision(9);
    std::string line;
    std::getline(in, line);
    out << line << '\n';
    while (std::getline(in, line)) {
        const std::size_t first = line.find(',') + 1;
        const std::size_t end = line.find(',', first);
        const double angle = std::atof(line.substr(first, end - first).c_str());
        out << line.substr(0, first) << std::fmod(angle, 2.0 * std::numbers::pi) << line.substr(end) << '\n';
    }
    return out.str();
}

}  // namespace

TEST_GROUP(ForceSensor) {
    Inputs inputs;

    /// Replays, and gives the rows in which `column` is filled.
    std::vector<CsvRow> filled_rows(const std::string& log, const std::string& tool, const char* column) {
        inputs.write("log.csv", log);
        inputs.write("tool.toml", tool);
        const Ended ended = inputs.replay();
        LONGS_EQUAL(0, ended.exit_code);
        error = ended.error;
        out = ended.out;
        std::vector<CsvRow> rows = csv_rows(inputs.read("out.csv"));
        std::erase_if(rows, [&](const CsvRow& row) { return row.at(column).empty(); });
        return rows;
    }
    void check_immersion(double immersion, double direction_rad) {
        const auto rows =
            filled_rows(face_mill_recording(immersion, direction_rad), face_mill_tool_text, "force_drop_immersion");
        CHECK(rows.size() > 100);
        for (const CsvRow& row : rows) {
            DOUBLES_EQUAL(immersion, number(row.at("force_drop_immersion")), 0.1 * immersion);
            CHECK(number(row.at("force_drop_immersion_sd")) > 0.0);
            STRCMP_EQUAL("", row.at("depth_shape_axial_depth_mm").c_str());
        }
    }
    void check_depths(const std::string& tool, double direction_rad) {
        const auto rows = filled_rows(end_mill_recording(20.0, 5.0, direction_rad), tool, "depth_shape_axial_depth_mm");
        CHECK(rows.size() > 50);
        for (const CsvRow& row : rows) {
            DOUBLES_EQUAL(1.2 * 7.62, number(row.at("depth_shape_axial_depth_mm")), 0.03 * 7.62);
            DOUBLES_EQUAL(20.0, number(row.at("depth_shape_axial_variation_percent")), 3.0);
            CHECK(number(row.at("depth_shape_axial_depth_sd_mm")) > 0.0);
        }
    }

    std::string error;
    std::string out;
};

TEST(ForceSensor, replay_tells_the_immersion_from_force_drops) {
    check_immersion(0.4, along_x);
    check_immersion(0.7, along_x);
}

TEST(ForceSensor, the_feed_may_go_in_any_direction) {
    check_immersion(0.4, to_the_left_and_back);
    check_depths(end_mill_tool_text, to_the_left_and_back);
}

TEST(ForceSensor, replay_tells_depths_and_their_variation_from_the_forces_shape) {
    check_depths(end_mill_tool_text, along_x);
}

TEST(ForceSensor, with_the_tips_angle_known_the_width_is_told_as_well_in_any_direction_of_the_feed) {
    const std::string tool = end_mill_tool_text + "tip_angle_deg = 17.19\ntip_angle_sd_deg = 0.3\n";
    for (const double direction_rad : {along_x, to_the_left_and_back}) {
        const auto rows =
            filled_rows(end_mill_recording(-20.0, 10.0, direction_rad), tool, "depth_shape_radial_width_mm");
        CHECK(rows.size() > 50);
        for (const CsvRow& row : rows) {
            DOUBLES_EQUAL(10.0, number(row.at("depth_shape_radial_variation_percent")), 4.0);
            DOUBLES_EQUAL(-20.0, number(row.at("depth_shape_axial_variation_percent")), 4.0);
        }
    }
}

TEST(ForceSensor, an_angle_that_begins_again_after_each_turn_goes_on) {
    const std::string log = wrapped_angles(face_mill_recording(0.4, along_x));
    for (const CsvRow& row : filled_rows(log, face_mill_tool_text, "force_drop_immersion")) {
        DOUBLES_EQUAL(0.4, number(row.at("force_drop_immersion")), 0.04);
    }
    CHECK(filled_rows(log, face_mill_tool_text, "force_drop_immersion").size() > 100);
}

TEST(ForceSensor, what_the_tools_file_lacks_is_told_once_and_its_cells_are_empty) {
    const auto rows = filled_rows(face_mill_recording(0.4, along_x), tool_text, "force_drop_immersion");
    LONGS_EQUAL(0, rows.size());
    LONGS_EQUAL(2, std::count(error.begin(), error.end(), '\n'));
    CHECK(contains(error, "[force_drop]"));
    CHECK(contains(error, "[depth_shape]"));
    filled_rows(face_mill_recording(0.4, along_x), with(face_mill_tool_text, "low_pass_hz = 300.0", ""),
                "force_drop_immersion");
    CHECK(contains(error, "low_pass_hz"));
}

TEST(ForceSensor, a_low_pass_of_half_the_corner_that_was_told_gives_no_immersion_and_is_named) {
    const auto rows =
        filled_rows(face_mill_recording(0.4, along_x),
                    with(face_mill_tool_text, "low_pass_hz = 300.0", "low_pass_hz = 600.0"), "force_drop_immersion");
    LONGS_EQUAL(0, rows.size());
    CHECK(contains(out, "force_sensor.low_pass_hz is not as told"));
}

TEST(ForceSensor, one_force_alone_is_told_and_not_used) {
    const std::string log =
        "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s,fx_N\n0,0,3,1,5,7\n";
    inputs.write("log.csv", log);
    const Ended ended = inputs.replay();
    LONGS_EQUAL(0, ended.exit_code);
    CHECK(contains(ended.error, "fy_N"));
    CHECK(!contains(inputs.read("out.csv"), "force_drop"));
}

TEST(ForceSensor, a_truncated_recording_is_refused_and_leaves_nothing) {
    const std::string whole = face_mill_recording(0.4, along_x);
    const std::string cut_off = whole.substr(0, whole.rfind(','));
    const auto lines = std::count(cut_off.begin(), cut_off.end(), '\n') + 1;
    inputs.write("log.csv", cut_off);
    inputs.write("tool.toml", face_mill_tool_text);
    STRCMP_EQUAL("", not_refused(inputs.replay(), {"log.csv:" + std::to_string(lines)}).c_str());
    CHECK(!std::filesystem::exists(inputs.path("out.csv")));
}

TEST(ForceSensor, a_recording_with_forces_and_without_a_velocity_is_refused) {
    inputs.write("log.csv", "time_s,spindle_angle_rad,fx_N,fy_N\n0,0,1,2\n");
    STRCMP_EQUAL("", not_refused(inputs.replay(), {"log.csv:1:", "x_velocity_mm_s"}).c_str());
    CHECK(!std::filesystem::exists(inputs.path("out.csv")));
}
