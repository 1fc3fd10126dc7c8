// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_files.hpp"
#include "files/input_error.hpp"
#include "firmware/parameters_in.hpp"
#include "parameters/parameter_table.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::string machine = "[spindle]\nK_t1_Nm_per_A = 0.7\n";

const std::string tool_and_control =
    "[tool]\nteeth = 4\ndiameter_mm = 10\nflute_length_mm = 22\ntooth_force_limit_N = 700\n[control]\n"
    "entry_feed_per_tooth_mm = 0.03\nair_feed_per_tooth_mm = 0.03\nmax_feed_per_tooth_mm = 0.2\n";

const std::string cutting = "[cutting]\nk_s_N_per_mm2 = 1650.25\nk_1 = 0.376\n";

millforce::firmware::Parameters<float> read(const std::string& machine_text, const std::string& tool_text) {
    const TemporaryFolder folder;
    return read_parameters(folder.write("machine.toml", machine_text).string(),
                           folder.write("tool.toml", tool_text).string());
}

std::string error_of(const std::string& machine_text, const std::string& tool_text) {
    return message_of<InputError>([&] { read(machine_text, tool_text); });
}

}  // namespace

TEST_GROUP(ParameterFiles){};

TEST(ParameterFiles, take_the_tables_of_a_calibration_as_they_are) {
    const auto p =
        read(machine +
                 "K_t1_Nm_per_A_se = 0.01\ntorque_residual_rms_Nm = 0.1\n[y]\nK_x1_negative_A_min2_per_m2 = 0.5\n"
                 "K_x1_negative_A_min2_per_m2_se = 0.01\nK_x3_A = 1.5\nK_x3_A_se = 0\ngravity_A = -0.25\n"
                 "friction_residual_rms_A = 0.002\n[x]\nmass_kg = 95\nmass_kg_se = 1.0\ncoulomb_N = 20\n"
                 "coulomb_N_se = 0.5\nnegative_viscous_N_s_per_m = 200\nresidual_rms_N = 2.5\n",
             tool_and_control + cutting +
                 "k_s_N_per_mm2_se = 20\nK_re_N_per_mm = -1.1\nminimum_feed_per_tooth_mm = 0.01\n"
                 "maximum_feed_per_tooth_mm = 0.1\ncut_side = \"up\"\n");
    DOUBLES_EQUAL(0.5, static_cast<double>(p.machine.axes[1].negative.K_x1_A_min2_per_m2), 1e-7);
    DOUBLES_EQUAL(1.5, static_cast<double>(p.machine.axes[1].K_x3_A), 1e-7);
    DOUBLES_EQUAL(-0.25, static_cast<double>(p.machine.axes[1].gravity_A), 1e-7);
    DOUBLES_EQUAL(95.0, static_cast<double>(p.machine.axes[0].mass_kg), 1e-5);
    DOUBLES_EQUAL(-1.1, static_cast<double>(p.tool.law.K_re_N_per_mm), 1e-6);
}

TEST(ParameterFiles, give_the_default_of_a_key_that_is_not_there) {
    const auto p = read(machine, tool_and_control + cutting);
    DOUBLES_EQUAL(30.0, static_cast<double>(p.tool.helix_deg), 0.0);
    DOUBLES_EQUAL(1.5, static_cast<double>(p.machine.cnc.override_max), 0.0);
    DOUBLES_EQUAL(0.0, static_cast<double>(p.machine.axes[2].K_x4_N_per_A), 0.0);
}

TEST(ParameterFiles, give_the_default_of_every_optional_key) {
    const auto p = read(machine, tool_and_control + cutting);
    const auto read_values = millforce::firmware::values_of(p);
    const auto defaults = millforce::firmware::values_of({});
    std::size_t next = 0;
    millforce::firmware::for_each_parameter(
        p, [&](const millforce::firmware::ParameterName& name, const auto&, float, float) {
            if (!row_of(name).is_required) {
                CHECK_EQUAL_TEXT(defaults[next], read_values[next], name.key);
            }
            ++next;
        });
    CHECK(p.tool.side == millforce::estimation::CutSide::unknown);
    DOUBLES_EQUAL(0.05, static_cast<double>(p.tool.law.K_s_relative_sd), 1e-8);
    DOUBLES_EQUAL(0.05, static_cast<double>(p.tool.law.r_1_relative_sd), 1e-8);
}

TEST(ParameterFiles, say_what_type_of_value_a_key_takes) {
    const auto machine_error = [](const std::string& lines) {
        return error_of(machine + lines, tool_and_control + cutting);
    };
    const auto tool_error = [](const std::string& lines) {
        return error_of(machine, tool_and_control + lines + cutting);
    };
    CHECK(contains(machine_error("K_t2_Nm = \"low\"\n"),
                   "machine.toml:3:11: spindle.K_t2_Nm = \"low\": expected a number from -10000 to 10000 N·m"));
    CHECK(contains(machine_error("current_sd_A = -1\n"),
                   "spindle.current_sd_A = -1: expected a number from 0 to 1000 A"));
    CHECK(contains(machine_error("[bus]\nsync_id = 128.5\n"),
                   "machine.toml:4:11: bus.sync_id = 128.5: expected an integer from 1 to 2047"));
    CHECK(contains(machine_error("[bus]\nsync_id = 2048\n"), "bus.sync_id = 2048: expected an integer from 1 to 2047"));
    CHECK(contains(machine_error("[bus]\nproduces_sync = \"yes\"\n"),
                   "bus.produces_sync = \"yes\": expected true or false"));
    CHECK(contains(machine_error("[bus]\nproduces_sync = 1\n"), "bus.produces_sync = 1: expected true or false"));
    CHECK(
        contains(machine_error("[bus]\nrole = \"slave\"\n"), "bus.role = \"slave\": expected one of listener, master"));
    CHECK(contains(tool_error("monitor_only = \"true\"\n"), "control.monitor_only = \"true\": expected true or false"));
}

TEST(ParameterFiles, take_a_whole_number_with_a_decimal_point_as_an_integer) {
    const auto p = read(machine + "[bus]\nsync_id = 129.0\n", tool_and_control + cutting);
    UNSIGNED_LONGS_EQUAL(129, p.machine.bus.sync_id);
}

TEST(ParameterFiles, take_the_ends_of_a_range_as_they_are_written) {
    const auto p = read(machine, tool_and_control + cutting + "p_s = -0.95\n");
    DOUBLES_EQUAL(-0.95, static_cast<double>(p.tool.law.p_s), 1e-7);
    CHECK(contains(error_of(machine, tool_and_control + cutting + "p_s = -0.951\n"), "a number from -0.95 to 0.5"));
}

TEST(ParameterFiles, refuse_a_standard_error_that_is_none_or_of_a_key_that_is_none) {
    const auto error = [](const std::string& line) { return error_of(machine, tool_and_control + cutting + line); };
    CHECK(contains(error("k_1_se = -0.1\n"), "cutting.k_1_se = -0.1: expected a number from 0 to"));
    CHECK(contains(error("k_1_se = nan\n"), "cutting.k_1_se = nan"));
    CHECK(contains(error("k_1_se = \"small\"\n"), "cutting.k_1_se = \"small\""));
    CHECK(contains(error("k_7_se = 0.1\n"), "cutting.k_7_se: unknown key; known keys: k_s_N_per_mm2,"));
    CHECK(contains(error("cut_side_se = 0.1\n"), "cutting.cut_side_se: unknown key"));
}

TEST(ParameterFiles, check_what_is_there_for_information_alone) {
    CHECK(
        contains(error_of(machine, tool_and_control + cutting + "cut_side = \"left\"\n"), "expected one of down, up"));
    CHECK(contains(error_of(machine + "[x]\ncoulomb_N = inf\n", tool_and_control + cutting), "x.coulomb_N = inf"));
    CHECK(contains(error_of(machine + "[x]\ncoulomb = 20\n", tool_and_control + cutting), "did you mean coulomb_N?"));
    CHECK(
        contains(error_of(machine + "coulomb_N = 20\n", tool_and_control + cutting), "spindle.coulomb_N: unknown key"));
}

TEST(ParameterFiles, of_one_file_are_not_keys_of_the_other) {
    CHECK(contains(error_of(machine + "[tool]\nteeth = 4\n", tool_and_control + cutting),
                   "machine.toml:3:1: tool: unknown"));
    CHECK(contains(error_of(machine, tool_and_control + cutting + "[x]\nmass_kg = 1\n"), "x: unknown key"));
}

TEST(ParameterFiles, the_cutting_table_alone_is_read_in_full_precision_beside_anything) {
    const TemporaryFolder folder;
    const auto table =
        read_cutting_table(folder.write("a.toml", "[machine]\nanything = 1\n" + cutting + "p_s = -0.117\n").string());
    DOUBLES_EQUAL(1650.25, table.law.k_s_N_per_mm2, 0.0);
    DOUBLES_EQUAL(-0.117, table.law.p_s, 0.0);
    CHECK(!table.side.has_value());
    DOUBLES_EQUAL(0.05, table.law.K_s_relative_sd, 0.0);
}
