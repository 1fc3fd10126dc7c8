// SPDX-License-Identifier: Apache-2.0
#include "calibration/recorded_forces.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string table_header = "recording,start_s,end_s,tool_diameter_mm,flutes,axial_depth_mm,radial_width_mm\n";

firmware::Parameters<float> four_flutes_of_10_mm() {
    firmware::Parameters<float> parameters;
    parameters.tool.diameter_mm = 10.0F;
    parameters.tool.teeth = 4;
    return parameters;
}

}  // namespace

TEST_GROUP(RecordedForces) {
    TemporaryFolder folder;

    std::vector<StretchConditions> cuts_in(const std::string& rows) {
        return cuts_of_tool(folder.write("cuts.csv", table_header + rows), {folder.path("a.csv")},
                            four_flutes_of_10_mm().tool);
    }
    std::string error_of(const std::string& rows) {
        return message_of<InputError>([&] { static_cast<void>(cuts_in(rows)); });
    }
    std::filesystem::path recording() {
        std::string text = "time_s,spindle_angle_rad,spindle_current_A,x_current_A,x_velocity_mm_s\n";
        for (int k = 0; k < 100; ++k) {
            text += fmt::format("{:.2f},{},3,2,5\n", 0.01 * k, k);
        }
        return folder.write("a.csv", text);
    }
};

TEST(RecordedForces, are_of_the_rows_of_the_table_in_which_the_tool_cuts) {
    const auto cuts = cuts_in("a.csv,0,1,10,4,,\na.csv,2,3,10,4,1,5\n");
    LONGS_EQUAL(1, cuts.size());
    DOUBLES_EQUAL(2.0, cuts[0].start_s, 0.0);
    STRCMP_CONTAINS("cuts.csv: no row with a depth and a width", error_of("a.csv,0,1,10,4,,\n").c_str());
    STRCMP_CONTAINS("cuts.csv:2: a tool of Ø10 mm with 3 flutes, expected the tool file's Ø10 mm and 4",
                    error_of("a.csv,0,1,10,3,1,5\n").c_str());
    STRCMP_CONTAINS("cuts.csv:2: a tool of Ø12 mm with 4 flutes", error_of("a.csv,0,1,12,4,1,5\n").c_str());
}

TEST(RecordedForces, are_read_between_the_times_of_their_cut_whether_named_by_file_or_by_path) {
    const auto file = recording();
    for (const std::string& name : {std::string("a.csv"), file.string()}) {
        const auto cuts = cuts_in(name + ",0.2,0.5,10,4,1,5\n" + name + ",0.4,0.6,10,4,2,5\n");
        std::vector<int> rows(2, 0);
        double longest_step_s = 0.0;
        read_recorded_forces({file}, cuts, four_flutes_of_10_mm(), [&](std::size_t place, float dt_s, const auto&) {
            ++rows[place];
            longest_step_s = std::max(longest_step_s, static_cast<double>(dt_s));
        });
        CHECK(rows[0] >= 30 && rows[0] <= 31);
        CHECK(rows[1] >= 20 && rows[1] <= 21);
        DOUBLES_EQUAL(0.01, longest_step_s, 1e-6);
    }
}

TEST(RecordedForces, of_a_tool_with_a_force_sensor_need_its_columns) {
    const auto file = recording();
    const auto cuts = cuts_in("a.csv,0.2,0.5,10,4,1,5\n");
    auto parameters = four_flutes_of_10_mm();
    parameters.tool.force_sensor.low_pass_hz = 500.0F;
    const std::string error = message_of<InputError>(
        [&] { read_recorded_forces({file}, cuts, parameters, [](std::size_t, float, const auto&) {}); });
    STRCMP_CONTAINS("a.csv:1: no column 'fx_N' or 'fy_N', expected the force sensor", error.c_str());
}
