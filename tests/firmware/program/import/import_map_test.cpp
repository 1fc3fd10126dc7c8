// SPDX-License-Identifier: Apache-2.0
#include "import/import_map.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <numbers>

using namespace millforce::host;
using namespace millforce::test;

namespace {

std::string error_of(const std::string& text) {
    const TemporaryFolder folder;
    const std::string file = folder.write("map.toml", text).string();
    const std::string message = message_of<InputError>([&] { static_cast<void>(read_import_map(file)); });
    return message.starts_with(file) ? "map" + message.substr(file.size()) : message;
}

/// What a value of 1 in the source becomes.
double factor_of(const std::string& column, const std::string& keys) {
    const TemporaryFolder folder;
    const ImportMap map =
        read_import_map(folder.write("map.toml", "[" + column + "]\nsource = \"s\"\n" + keys).string());
    return map.columns.front().factor;
}

}  // namespace

TEST_GROUP(ImportMap){};

TEST(ImportMap, knows_the_units_of_each_quantity) {
    constexpr double turn = 2.0 * std::numbers::pi;
    DOUBLES_EQUAL(turn / 360.0, factor_of("spindle_angle_rad", "unit = \"deg\""), 1e-15);
    DOUBLES_EQUAL(turn / 4096.0, factor_of("spindle_angle_rad", "unit = \"counts\"\ncounts_per_rev = 4096"), 1e-15);
    DOUBLES_EQUAL(turn / 60.0, factor_of("spindle_angle_rad", "derived_from = \"speed\"\nunit = \"rpm\""), 1e-15);
    DOUBLES_EQUAL(0.001, factor_of("x_current_A", "unit = \"mA\""), 1e-15);
    DOUBLES_EQUAL(0.115, factor_of("x_current_A", "unit = \"%\"\nrated_A = 11.5"), 1e-15);
    DOUBLES_EQUAL(0.0115, factor_of("x_current_A", "unit = \"permille\"\nrated_A = 11.5"), 1e-15);
    DOUBLES_EQUAL(1.0 / 60.0, factor_of("y_velocity_mm_s", "unit = \"mm/min\""), 1e-15);
    DOUBLES_EQUAL(1000.0 / 60.0, factor_of("y_velocity_mm_s", "unit = \"m/min\""), 1e-12);
    DOUBLES_EQUAL(25.4 / 60.0, factor_of("y_velocity_mm_s", "unit = \"in/min\""), 1e-15);
    DOUBLES_EQUAL(5.0, factor_of("y_velocity_mm_s", "unit = \"rev/s\"\nscrew_pitch_mm = 5"), 1e-15);
    DOUBLES_EQUAL(
        5.0 / 8192.0,
        factor_of("y_velocity_mm_s",
                  "derived_from = \"position\"\nunit = \"counts\"\nscrew_pitch_mm = 5\ncounts_per_rev = 8192"),
        1e-15);
    DOUBLES_EQUAL(4.4482216152605, factor_of("fx_N", "unit = \"lbf\""), 1e-12);
    DOUBLES_EQUAL(0.01, factor_of("override", "unit = \"%\""), 1e-15);
    DOUBLES_EQUAL(1.0 / 60.0, factor_of("programmed_feed_mm_s", "unit = \"mm/min\""), 1e-15);
    DOUBLES_EQUAL(turn / 60.0, factor_of("commanded_speed_rad_s", "unit = \"rpm\""), 1e-15);
}

TEST(ImportMap, multiplies_sign_scale_and_unit) {
    DOUBLES_EQUAL(-0.0025, factor_of("z_current_A", "unit = \"mA\"\nsign = -1\nscale = 2.5"), 1e-15);
}

TEST(ImportMap, names_the_key_its_place_and_what_was_expected) {
    const std::string column = "[x_current_A]\nsource = \"i\"\n";
    STRCMP_EQUAL("map:3:8: x_current_A.unit = \"Amp\": expected one of A, mA, %, permille, rated",
                 error_of(column + "unit = \"Amp\"\n").c_str());
    CHECK(contains(error_of(column + "unit = \"%\"\n"), "x_current_A.rated_A: missing, expected a number"));
    CHECK(contains(error_of(column + "sign = 0\n"), "x_current_A.sign = 0: expected 1 or -1"));
    CHECK(contains(error_of(column + "scale = 0\n"), "expected a factor that is not 0"));
    CHECK(contains(error_of(column + "unti = \"A\"\n"), "unknown key; did you mean unit?"));
    CHECK(contains(error_of(column + "wrap = 360\n"), "x_current_A.wrap: unknown key"));
    CHECK(contains(error_of(column + "source_number = 2\n"), "expected either source or source_number"));
    CHECK(contains(error_of("[x_current_A]\nunit = \"A\"\n"), "x_current_A.source: missing"));
    CHECK(contains(error_of("[x_current_A]\nsource = \" \"\n"), "expected the name of a column"));
    CHECK(contains(error_of("[x_curent_A]\nsource = \"i\"\n"), "x_curent_A: unknown key; did you mean x_current_A?"));
    CHECK(contains(error_of("[source]\nformat = \"xls\"\n"),
                   "expected one of csv, odrive, sinumerik, halsampler, candump"));
    CHECK(contains(error_of("[spindle_angle_rad]\nsource = \"s\"\nderived_from = \"position\"\n"),
                   "expected one of speed, index"));
    CHECK(contains(error_of("[rapid]\nsource = \"m\"\nequals = 1\nthreshold = 1\n"),
                   "expected either equals or threshold"));
    CHECK(contains(error_of("[rapid]\nsource = \"m\"\nsign = -1\n"), "rapid.sign: unknown key"));
    CHECK(contains(error_of("[programmed_feed_mm_s]\nsource = \"F\"\nderived_from = \"position\"\n"),
                   "derived_from: unknown key"));
    CHECK(contains(error_of("[time_s]\nunit = \"s\"\n"), "time_s.rate_hz: missing"));
    CHECK(contains(error_of("[time_s]\nsource = \"t\"\n"), "no column of a recording"));
}

TEST(ImportMap, looks_for_the_dbc_file_beside_the_map) {
    const TemporaryFolder folder;
    const auto file = folder.write("map.toml", "[source]\ndbc = \"bus.dbc\"\n[x_current_A]\nsource = \"i\"\n");
    STRCMP_EQUAL(folder.path("bus.dbc").c_str(), read_import_map(file.string()).dbc.c_str());
}
