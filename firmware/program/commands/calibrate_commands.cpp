// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "calibration/cutting_calibration.hpp"
#include "calibration/estimate.hpp"
#include "calibration/force_drop_calibration.hpp"
#include "calibration/friction_calibration.hpp"
#include "calibration/roughness_calibration.hpp"
#include "calibration/spindle_calibration.hpp"
#include "calibration/standard_cut_calibration.hpp"
#include "calibration/warm_up_calibration.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "files/parameter_files.hpp"

namespace millforce::host {

namespace {

using estimation::CutSide;
using estimation::CuttingLawForm;

CLI::CheckedTransformer law_names() {
    CLI::CheckedTransformer names(std::map<std::string, CuttingLawForm>{{"linear_edge", CuttingLawForm::linear_edge},
                                                                        {"power", CuttingLawForm::power},
                                                                        {"combined", CuttingLawForm::combined}},
                                  CLI::ignore_case);
    names.description("{linear_edge,power,combined}");
    return names;
}

CLI::CheckedTransformer side_names() {
    CLI::CheckedTransformer names(
        std::map<std::string, CutSide>{{"down", CutSide::down}, {"up", CutSide::up}, {"unknown", CutSide::unknown}},
        CLI::ignore_case);
    names.description("{down,up,unknown}");
    return names;
}

template <typename Options>
void add_data_and_output(CLI::App* command, Options& options) {
    command->add_option("data", options.data, "Measured data (CSV)")->required()->type_name("DATA.csv...");
    command->add_option("-o,--output", options.output, "The fitted parameters")->required()->type_name("FILE.toml");
}

void add_friction(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<FrictionCalibrationOptions>();
    CLI::App* command = calibrate->add_subcommand("friction", "Feed axes: friction by direction, mass, weight");
    command->footer(
        "Data: a recording of air cuts (time_s, AXIS_velocity_mm_s, AXIS_current_A; at least three steady feeds in "
        "each\n"
        "direction), or one axis in motion (time_s, position_m, motor_force_N). The tables go into machine.toml as "
        "they\n"
        "are. Exit code 1: the friction changed within the data.");
    add_data_and_output(command, *options);
    command->add_option("--axis", options->axis, "Axis of data that holds a single one")
        ->check(CLI::IsMember({"x", "y", "z"}))
        ->capture_default_str();
    command->add_option("--low-pass", options->low_pass_hz, "Zero-phase filter of position and force, Hz")
        ->check(number_from(0.1, 1e4))
        ->capture_default_str();
    command->add_option("--minimum-speed", options->minimum_speed_mm_s, "Slower samples are pre-sliding, mm/s")
        ->check(number_from(0.001, 1e4))
        ->capture_default_str();
    command->callback([options, &exit_code] { exit_code = calibrate_friction(*options, std::cout); });
}

void add_spindle(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<SpindleCalibrationOptions>();
    CLI::App* command = calibrate->add_subcommand("spindle", "Spindle: torque per ampere, idle torque, inertia");
    command->footer(
        "Data: spindle_current_A and spindle_torque_Nm, with spindle_speed_rad_s or with time_s and "
        "spindle_angle_rad.\n"
        "The table goes into machine.toml as it is.");
    add_data_and_output(command, *options);
    command->add_option("--low-pass", options->low_pass_hz, "Zero-phase filter of a recording, Hz")
        ->check(number_from(0.01, 1e4))
        ->capture_default_str();
    command->callback([options, &exit_code] { exit_code = calibrate_spindle(*options, std::cout); });
}

void add_standard_cut(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<StandardCutOptions>();
    CLI::App* command = calibrate->add_subcommand("standard-cut", "Spindle and feed drives: gains from standard cuts");
    command->footer(
        "Data: recordings of cuts with a tool and workpiece whose coefficients are in the database, with running in "
        "air\n"
        "between them. CUTS.csv tells which stretch is which cut: start_s, end_s, tool_diameter_mm, flutes,\n"
        "axial_depth_mm and radial_width_mm (0: in air), and recording where there are several. The tables go into\n"
        "machine.toml as they are.");
    add_data_and_output(command, *options);
    command->add_option("--cuts", options->cuts, "Which stretch is which cut")->required()->type_name("CUTS.csv");
    command->add_option("--machine", options->machine, "With the friction of the air cuts")
        ->required()
        ->type_name("M.toml");
    command->add_option("--database", options->database, "Coefficients of the standard tool and workpiece")
        ->required()
        ->type_name("LIBRARY.toml");
    command->add_option("--entry", options->entry, "Name in the database; default: its only one")->type_name("NAME");
    command->add_option("--side", options->side, "down or up")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, CutSide>{{"down", CutSide::down}, {"up", CutSide::up}}, CLI::ignore_case));
    command->callback([options, &exit_code] { exit_code = calibrate_standard_cut(*options, std::cout); });
}

void add_warm_up(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<WarmUpCalibrationOptions>();
    CLI::App* command = calibrate->add_subcommand("warm-up", "Spindle: idle torque of the cold bearing, time constant");
    command->footer(
        "Data: a recording of the spindle idling at one speed from cold for ten minutes or more (time_s,\n"
        "spindle_angle_rad, spindle_current_A). The table goes into machine.toml as it is.");
    command->add_option("data", options->data, "Recording of the idling spindle")->required()->type_name("IDLE.csv");
    command->add_option("--machine", options->machine, "With the spindle's torque per ampere")
        ->required()
        ->type_name("M.toml");
    command->add_option("-o,--output", options->output, "The fitted parameters")->required()->type_name("FILE.toml");
    command->callback([options, &exit_code] { exit_code = calibrate_warm_up(*options, std::cout); });
}

void add_cutting(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<CuttingCalibrationOptions>();
    CLI::App* command = calibrate->add_subcommand("cutting", "Material and tool: coefficients from measured cuts");
    command->footer(
        "Data: tool_diameter_mm, flutes, spindle_rad_s, axial_depth_mm, radial_width_mm, feed_mm_s, spindle_torque_Nm "
        "and\n"
        "normal_force_N or feed_force_N; cuts at two feeds and several widths. Or recordings of\n"
        "drive currents, with --cuts and --machine. The table goes into tool.toml as it is.\n"
        "Exit code 1: fewer than nine of ten held-out values lie within twice their stated deviation.");
    add_data_and_output(command, *options);
    command->add_option("--side", options->side, "Side of the cuts; unknown: from the data")->transform(side_names());
    command->add_option("--cuts", options->cuts, "Table of the cuts in recordings of drive currents")
        ->type_name("CUTS.csv");
    command->add_option("--machine", options->machine, "Calibrated drives, for recordings")->type_name("M.toml");
    command->add_option("--law", options->asked_form, "Which law to fit")->transform(law_names());
    command->callback([options, &exit_code] { exit_code = calibrate_cutting(*options, std::cout); });
}

void add_roughness(CLI::App* calibrate, int& exit_code) {
    auto options = std::make_shared<RoughnessCalibrationOptions>();
    CLI::App* command = calibrate->add_subcommand("roughness", "Tool and material: R_a or R_z from cutting tests");
    command->footer(
        "Data, one cutting test a row: spindle_speed_rpm, feed_mm_rev (per revolution), tool_diameter_mm,\n"
        "axial_depth_mm, force_ratio (F_x/F_z) or feed_force_N and axial_force_N, and the measured Ra_um or Rz_um.\n"
        "At least 7 tests; each variable must change on its own, or be held. The table goes into tool.toml as it is.\n"
        "Exit code 1: fewer than 85 of 100 tests lie in the 95 % interval of the model fitted without them.");
    add_data_and_output(command, *options);
    command->add_option("--measure", options->measure, "Ra or Rz; default: Ra where the data have it")
        ->check(CLI::IsMember({"Ra", "Rz"}));
    command->add_option("--hold", options->held, "Column that the shop does not vary: its exponent is not fitted")
        ->check(CLI::IsMember(std::vector<std::string>(roughness_columns.begin(), roughness_columns.end())));
    command->callback([options, &exit_code] { exit_code = calibrate_roughness(*options, std::cout); });
}

using ForceShapeCalibration = int (*)(const ForceShapeCalibrationOptions&, std::ostream&);

void add_force_shape(CLI::App* command, int& exit_code, ForceShapeCalibration calibration) {
    auto options = std::make_shared<ForceShapeCalibrationOptions>();
    add_data_and_output(command, *options);
    command->add_option("--cuts", options->cuts, "Which stretch is which cut")->required()->type_name("CUTS.csv");
    command->add_option("--machine", options->machine, "Machine parameters")->required()->type_name("M.toml");
    command->add_option("--tool", options->tool, "Tool parameters, with the force sensor's low-pass")
        ->required()
        ->type_name("T.toml");
    command->callback([options, &exit_code, calibration] { exit_code = calibration(*options, std::cout); });
}

void add_force_drop(CLI::App* calibrate, int& exit_code) {
    CLI::App* command = calibrate->add_subcommand("force-drop", "Tool and material: immersion from force drops");
    command->footer(
        "Data: recordings of steady cuts of known width with a force sensor (fx_N, fy_N), or with feed drives where "
        "both\n"
        "axes travel and tooth passing is slow. CUTS.csv tells which stretch is which cut: start_s, end_s,\n"
        "tool_diameter_mm, flutes, axial_depth_mm and radial_width_mm. Feeds must differ by a factor of 1.5, widths\n"
        "should span those of the work. The table goes into tool.toml as it is.\n"
        "Exit code 1: the immersion of a cut, by the law of the others, is off by more than 10 %.");
    add_force_shape(command, exit_code, calibrate_force_drop);
}

void add_tip_angle(CLI::App* calibrate, int& exit_code) {
    CLI::App* command = calibrate->add_subcommand("tip-angle",
                                                  "Tool in its holder: where the teeth stand, for depths "
                                                  "from the force's shape");
    command->footer(
        "Data: recordings of steady cuts of known depth and width with a force sensor (fx_N, fy_N); one is enough.\n"
        "CUTS.csv as for force-drop. The key goes into tool.toml's [depth_shape] as it is.\n"
        "Exit code 1: the cuts disagree by more than four standard deviations.");
    add_force_shape(command, exit_code, calibrate_tip_angle);
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
    CLI::App* calibrate = app.add_subcommand("calibrate", "Fits parameters to measured data, with standard errors");
    calibrate->require_subcommand(1);
    add_friction(calibrate, exit_code);
    add_spindle(calibrate, exit_code);
    add_cutting(calibrate, exit_code);
    add_standard_cut(calibrate, exit_code);
    add_warm_up(calibrate, exit_code);
    add_roughness(calibrate, exit_code);
    add_force_drop(calibrate, exit_code);
    add_tip_angle(calibrate, exit_code);
}

void add_estimate(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<EstimateOptions>();
    CLI::App* command = app.add_subcommand("estimate", "Forces from conditions; depth or width from measured torque");
    command->footer(
        "Conditions: tool_diameter_mm, flutes, spindle_rad_s, feed_mm_s, and axial_depth_mm, radial_width_mm and\n"
        "spindle_torque_Nm as far as they are known. An empty cell is \"no estimate\".");
    command->add_option("conditions", options->conditions, "One straight cut a row")
        ->required()
        ->type_name("CONDITIONS.csv");
    command->add_option("--tool", options->tool, "Tool with its [cutting] table")->required()->type_name("T.toml");
    command->add_option("-o,--output", options->output, "The rows with estimates; default: standard output")
        ->type_name("OUT.csv");
    command->add_option("--side", options->side, "down, up or unknown: the tool's")->transform(side_names());
    command->callback([options, &exit_code] { exit_code = estimate(*options, std::cout); });
}

}  // namespace millforce::host
