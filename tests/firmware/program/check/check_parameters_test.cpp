// SPDX-License-Identifier: Apache-2.0
#include "check/check_parameters.hpp"

#include <CppUTest/TestHarness.h>

#include <string>

#include "check/contradictions.hpp"
#include "firmware/program/check/made_recording.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

TEST_GROUP(ParameterCheck) {
    firmware::Parameters<float> parameters = right_parameters();

    /// Exactly one finding, with this beginning and this key.
    void check_finds(const char* begin, const char* key) const {
        const std::string lines = lines_of(check_parameters(parameters));
        const bool is_one = lines.find('\n') == lines.size() - 1;
        if (!is_one || !lines.starts_with(begin) || !lines.ends_with(std::string("[") + key + "]\n")) {
            STRCMP_EQUAL((std::string(begin) + " … [" + key + "]").c_str(), lines.c_str());
        }
    }
};

TEST(ParameterCheck, finds_nothing_in_the_machine_and_the_tools_of_the_scenarios) {
    const std::string scenarios = MILLFORCE_SOURCE_DIR "/sim/scenarios/";
    for (const char* tool : {"tools/endmill_10mm.toml", "tools/facemill_40mm.toml", "tools/facemill_40mm_centred.toml",
                             "tools/facemill_40mm_dynamometer.toml", "commissioning/endmill_8mm.toml",
                             "commissioning/monitor_only.toml", "commissioning/facemill_40mm_dynamometer.toml"}) {
        const auto right = read_parameters(scenarios + "machines/vmc.toml", scenarios + tool);
        STRCMP_EQUAL("", lines_of(check_parameters(right)).c_str());
    }
}

TEST(ParameterCheck, finds_a_base_speed_in_rpm) {
    parameters.machine.spindle.base_speed_rad_s = 6000.0F;
    check_finds("warning: a base speed of 6000 rad/s is 57295.8 1/min; is it in 1/min?", "spindle.base_speed_rad_s");
}

TEST(ParameterCheck, finds_a_spindle_constant_per_mA) {
    parameters.machine.spindle.K_t1_Nm_per_A = 0.7e-3F;
    parameters.machine.spindle.inertia_kg_m2 = 0.001F;
    check_finds("error: the spindle idles at 1361 A, more than its rated 12 A", "spindle.K_t2_Nm");
}

TEST(ParameterCheck, finds_an_inertia_in_kg_cm2) {
    parameters.machine.spindle.inertia_kg_m2 = 40.0F;
    check_finds("error: an inertia of 40 kg·m² takes the spindle's 33.6 N·m more than 20 s", "spindle.inertia_kg_m2");
}

TEST(ParameterCheck, finds_a_friction_in_mA) {
    parameters.machine.axes[0].K_x3_A = 1000.0F;
    check_finds("error: x: a friction of 1001 A is more than the rated 12 A; is it in mA?", "x.K_x3_A");
}

TEST(ParameterCheck, finds_a_mass_in_g) {
    parameters.machine.axes[1].mass_kg = 50000.0F;
    check_finds("error: y: 5e+04 kg at cnc.acceleration_mm_s2 take more than the 5760 N", "y.mass_kg");
}

TEST(ParameterCheck, finds_a_feed_per_tooth_in_mm_per_min) {
    parameters.tool.control.entry_feed_per_tooth_mm = 1.0F;
    parameters.tool.control.max_feed_per_tooth_mm = 10.0F;
    const std::string lines = lines_of(check_parameters(parameters));
    CHECK(contains(lines, "error: a chip of 1 mm per tooth on a tool of Ø10 mm, expected at most 0.6 mm"));
    CHECK(contains(lines, "[control.entry_feed_per_tooth_mm]"));
    CHECK(contains(lines, "[control.max_feed_per_tooth_mm]"));
}

TEST(ParameterCheck, finds_a_cutting_pressure_in_another_unit) {
    parameters.tool.law.k_s_N_per_mm2 = 1.6883F;
    check_finds("error: a cutting pressure of 1.688 N/mm² at max_feed_per_tooth_mm", "cutting.k_s_N_per_mm2");
}

TEST(ParameterCheck, finds_a_largest_override_that_is_not_above_the_smallest) {
    parameters.machine.cnc.override_min = 0.6F;
    parameters.machine.cnc.override_max = 0.5F;
    check_finds("error: override_max = 0.5 is not above override_min = 0.6", "cnc.override_max");
}

TEST(ParameterCheck, finds_an_input_that_is_stale_before_the_next_sample) {
    parameters.machine.cnc.stale_s = 0.0015F;
    check_finds("error: the input would count as stale after 0.0015 s", "cnc.stale_s");
}

TEST(ParameterCheck, finds_a_sample_rate_that_is_not_that_of_the_bus) {
    parameters.machine.bus.sync_period_ms = 4.0F;
    check_finds("warning: 1000 Hz, and bus.sync_period_ms = 4 ms gives 250 Hz", "cnc.sample_rate_hz");
}

TEST(ParameterCheck, finds_velocities_that_the_bus_does_not_take) {
    parameters.machine.bus.drives[1].largest_velocity_mm_s = 20.0F;
    check_finds("warning: x: velocities above 20 mm/s are not used", "bus.x.largest_velocity_mm_s");
}

TEST(ParameterCheck, finds_an_idle_torque_that_would_turn_the_spindle) {
    parameters.machine.spindle.K_t2_Nm = 2.0F;
    check_finds("warning: 2 N·m at no current would turn the spindle by itself", "spindle.K_t2_Nm");
}

TEST(ParameterCheck, finds_a_negative_friction) {
    parameters.machine.axes[0].K_x3_A = -1.6F;
    check_finds("warning: x: the constant friction is negative, -1.6 A", "x.K_x3_A");
}

TEST(ParameterCheck, finds_a_velocity_floor_above_all_feeds) {
    parameters.machine.axes[1].velocity_floor_mm_s = 60.0F;
    check_finds("warning: y: no force below 60 mm/s, and the program's highest feed is 25 mm/s",
                "y.velocity_floor_mm_s");
}

TEST(ParameterCheck, finds_a_limit_below_the_force_of_the_edge_alone) {
    parameters.tool.tooth_force_limit_N = 400.0F;
    check_finds("warning: at a depth of 22 mm the edge alone loads a tooth by", "tool.tooth_force_limit_N");
    parameters.tool.declared_axial_depth_mm = 5.0F;
    STRCMP_EQUAL("", lines_of(check_parameters(parameters)).c_str());
}

TEST(ParameterCheck, adds_up_the_edge_force_of_a_straight_flute_and_turns_it_along_a_helix) {
    parameters.tool.law.K_te_N_per_mm = 30.0F;
    parameters.tool.law.K_re_N_per_mm = 40.0F;
    parameters.tool.helix_deg = 0.0F;
    DOUBLES_EQUAL(500.0, edge_force_of_tooth_N(parameters.tool, 10.0), 1e-9);
    parameters.tool.helix_deg = 45.0F;
    // Over 180° of lag the elements of the edge point to all sides of a half circle: 2/π of their sum.
    DOUBLES_EQUAL(500.0, edge_force_of_tooth_N(parameters.tool, 15.707963), 0.01);
    DOUBLES_EQUAL(500.0, edge_force_of_tooth_N(parameters.tool, 30.0), 0.01);
}

TEST(ParameterCheck, finds_contact_that_is_seen_only_above_the_limit) {
    parameters.tool.control.contact_force_N = 700.0F;
    check_finds("error: contact is seen from 700 N on, and a tooth may carry 700 N", "control.contact_force_N");
}

TEST(ParameterCheck, finds_a_flute_that_is_shorter_than_the_stated_depths) {
    parameters.tool.declared_axial_depth_mm = 25.0F;
    parameters.tool.tooth_force_limit_N = 900.0F;
    check_finds("error: a flute of 22 mm is shorter than control.declared_axial_depth_mm = 25", "tool.flute_length_mm");
    parameters.tool.declared_axial_depth_mm = 0.0F;
    parameters.tool.depth_shape.nominal_axial_depth_mm = 25.0F;
    check_finds("error: a flute of 22 mm is shorter than depth_shape.nominal_axial_depth_mm", "tool.flute_length_mm");
}

TEST(ParameterCheck, finds_a_width_beyond_the_tool) {
    parameters.tool.depth_shape.nominal_radial_width_mm = 12.0F;
    check_finds("error: a width of 12 mm is larger than the tool's Ø10 mm", "depth_shape.nominal_radial_width_mm");
}

TEST(ParameterCheck, finds_a_range_of_chips_that_is_none) {
    parameters.tool.law.minimum_chip_thickness_mm = 0.2F;
    check_finds("error: 0.1445 mm is below minimum_chip_thickness_mm = 0.2", "cutting.maximum_chip_thickness_mm");
}

TEST(ParameterCheck, finds_a_reference_chip_in_another_unit) {
    parameters.tool.law.reference_chip_thickness_mm = 5.0F;
    check_finds("warning: 5 mm is ten times or more beyond the calibrated chips",
                "cutting.reference_chip_thickness_mm");
}

TEST(ParameterCheck, finds_feeds_that_never_reach_the_calibrated_chips) {
    parameters.tool.control.max_feed_per_tooth_mm = 0.006F;
    parameters.tool.control.entry_feed_per_tooth_mm = 0.005F;
    check_finds("warning: no chip is as thick as the thinnest calibrated one", "control.max_feed_per_tooth_mm");
}

TEST(ParameterCheck, finds_an_entry_feed_above_the_largest) {
    parameters.tool.control.max_feed_per_tooth_mm = 0.016F;
    check_finds("error: 0.016 mm is below entry_feed_per_tooth_mm = 0.018", "control.max_feed_per_tooth_mm");
}

TEST_GROUP(CheckFinding){};

TEST(CheckFinding, is_counted_in_the_last_line_and_notes_are_nothing_wrong) {
    const Finding note{Severity::note, "a", "k"};
    const Finding warning{Severity::warning, "b", "k"};
    const Finding error{Severity::error, "c", "k"};
    STRCMP_EQUAL("nothing found; 0 notes", count_of({}).c_str());
    STRCMP_EQUAL("nothing found; 1 note", count_of({note}).c_str());
    STRCMP_EQUAL("3 found: 2 errors, 1 warning; 1 note", count_of({error, note, warning, error}).c_str());
    CHECK_FALSE(is_something_wrong({note}));
    CHECK(is_something_wrong({note, warning}));
    STRCMP_EQUAL("warning: b [k]", line_of(warning).c_str());
}
