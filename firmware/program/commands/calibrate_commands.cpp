// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <sstream>
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
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

using estimation::CutSide;
using estimation::CuttingLawForm;

template <typename Side>
void add_side(Command& command, Side& side, const std::string& help) {
    command.choice<CutSide>("--side", side, help,
                            {{"down", CutSide::down}, {"up", CutSide::up}, {"unknown", CutSide::unknown}});
}

template <typename Options>
void add_data_and_output(Command& command, Options& options) {
    command.option("data", options.data, "Measured data (CSV)").required().value_name("DATA.csv");
    command.output_file("-o,--output", options.output, "The fitted parameters").required().value_name("FILE.toml");
}

/// A refusal is one line on standard error alone: the report goes out when all is done.
template <typename Calibration, typename Options>
int report_when_done(Calibration calibration, const Options& options) {
    std::ostringstream report;
    const int exit_code = calibration(options, report);
    std::cout << report.str();
    return exit_code;
}

void add_friction(Command& calibrate) {
    auto options = std::make_shared<FrictionCalibrationOptions>();
    Command command = calibrate.subcommand("friction", "Feed axes: friction by direction, mass, weight");
    command.footer(
        "Data: a recording of air cuts (time_s, AXIS_velocity_mm_s, AXIS_current_A; at least three steady feeds in "
        "each\n"
        "direction), or one axis in motion (time_s, position_m, motor_force_N). Currents and forces are positive "
        "where\n"
        "the motor drives the axis in +. Copy the tables into machine.toml unchanged; a parameter that is smaller "
        "than\n"
        "its standard error is left out of the fit and of the file.\n"
        "Exit code 1: the friction changed within the data. Of a motion: the second half lies beyond what the first\n"
        "half predicts, or its friction differs by more than 10 % and four standard deviations. Of air cuts: the same\n"
        "from the first stretch to the last. Where the data cannot show it, the report says so, with exit code 0.\n"
        "Exit code 1, too: a warning asks for a unit.");
    add_data_and_output(command, *options);
    command.option("--axis", options->axis, "Axis, for data with a single axis")
        .one_of({"x", "y", "z"})
        .shows_default();
    command.option("--low-pass", options->low_pass_hz, "Zero-phase filter of position and force, Hz")
        .within(0.1, 1e4)
        .shows_default();
    command.option("--minimum-speed", options->minimum_speed_mm_s, "Samples below this speed in mm/s are ignored")
        .within(0.001, 1e4)
        .shows_default();
    command
        .option("--force-constant", options->force_constant_N_per_A,
                "Force per ampere of the motor, N/A, of motor_force_N: writes the friction as a current, too")
        .within(0.001, 1e5);
    command.on_run([options] { return report_when_done(calibrate_friction, *options); });
}

void add_spindle(Command& calibrate) {
    auto options = std::make_shared<SpindleCalibrationOptions>();
    Command command = calibrate.subcommand("spindle", "Spindle: torque per ampere, idle torque, inertia");
    command.footer(
        "Data: spindle_current_A and spindle_torque_Nm, with spindle_speed_rad_s or with time_s and "
        "spindle_angle_rad.\n"
        "The current is positive where the motor drives. Rows far from the fit are left out and named; rows that "
        "repeat\n"
        "another one exactly count once. The table goes into machine.toml as it is; a term that is smaller than its\n"
        "standard error, or that the rows do not show, is not in it.\n"
        "Exit code 1: a warning asks for the unit of the speed or the torque, which few spindles have.");
    add_data_and_output(command, *options);
    command.option("--low-pass", options->low_pass_hz, "Zero-phase filter of a recording, Hz")
        .within(0.01, 1e4)
        .shows_default();
    command.on_run([options] { return report_when_done(calibrate_spindle, *options); });
}

void add_standard_cut(Command& calibrate) {
    auto options = std::make_shared<StandardCutOptions>();
    Command command = calibrate.subcommand("standard-cut", "Spindle and feed drives: gains from standard cuts");
    command.footer(
        "Data: recordings of cuts with a tool and workpiece whose coefficients are in the database, with running in "
        "air\n"
        "between them. CUTS.csv says which stretch is which cut: start_s, end_s, tool_diameter_mm, flutes,\n"
        "axial_depth_mm and radial_width_mm (0: in air), and recording if there are several. The tables go into\n"
        "machine.toml as they are.\n"
        "Exit code 1: a warning asks for a unit, since a gain is not a third to three times the machine file's.");
    add_data_and_output(command, *options);
    command.option("--cuts", options->cuts, "Which stretch is which cut").required().value_name("CUTS.csv");
    command.option("--machine", options->machine, "Machine file with the friction of the air cuts")
        .required()
        .value_name("M.toml");
    command.option("--database", options->database, "Coefficients of the standard tool and workpiece")
        .required()
        .value_name("LIBRARY.toml");
    command.option("--entry", options->entry, "Name in the database; default: its only entry").value_name("NAME");
    command.choice<CutSide>("--side", options->side, "Side of the cuts; default: down",
                            {{"down", CutSide::down}, {"up", CutSide::up}});
    command.on_run([options] { return report_when_done(calibrate_standard_cut, *options); });
}

void add_warm_up(Command& calibrate) {
    auto options = std::make_shared<WarmUpCalibrationOptions>();
    Command command = calibrate.subcommand("warm-up", "Spindle: idle torque of the cold bearing, time constant");
    command.footer(
        "Data: a recording of the spindle idling at one speed from cold for ten minutes or more (time_s,\n"
        "spindle_angle_rad, spindle_current_A). The table goes into machine.toml as it is.\n"
        "Exit code 1: a warning asks for the unit of the angle or the time.");
    command.option("data", options->data, "Recording of the idling spindle").required().value_name("IDLE.csv");
    command.option("--machine", options->machine, "Machine file with the spindle's torque per ampere")
        .required()
        .value_name("M.toml");
    command.output_file("-o,--output", options->output, "The fitted parameters").required().value_name("FILE.toml");
    command.on_run([options] { return report_when_done(calibrate_warm_up, *options); });
}

void add_cutting(Command& calibrate) {
    auto options = std::make_shared<CuttingCalibrationOptions>();
    Command command = calibrate.subcommand("cutting", "Material and tool: coefficients from measured cuts");
    command.footer(
        "Data: tool_diameter_mm, flutes, spindle_rad_s, axial_depth_mm, radial_width_mm, feed_mm_s,\n"
        "spindle_torque_Nm and normal_force_N or feed_force_N; cuts at two feeds and several widths. Or recordings of\n"
        "drive currents, with --cuts and --machine. Copy the table into tool.toml unchanged.\n"
        "Signs: normal_force_N is positive where it pushes tool and wall apart, which it always does in down milling;\n"
        "feed_force_N is the force on the workpiece, positive along the feed; spindle_torque_Nm is positive.\n"
        "Rows that repeat another one exactly count once.\n"
        "Exit code 1: fewer than nine of ten held-out values lie within twice their stated deviation, or a warning "
        "asks "
        "for a\n"
        "unit.");
    add_data_and_output(command, *options);
    add_side(command, options->side, "Side of the cuts; unknown: the one that fits the forces");
    command.option("--cuts", options->cuts, "Table of the cuts, for recordings of drive currents")
        .value_name("CUTS.csv");
    command.option("--machine", options->machine, "Machine file with calibrated drives, for recordings")
        .value_name("M.toml");
    command.choice<CuttingLawForm>("--law", options->asked_form, "Law to fit",
                                   {{"linear_edge", CuttingLawForm::linear_edge},
                                    {"power", CuttingLawForm::power},
                                    {"combined", CuttingLawForm::combined}});
    command.on_run([options] { return report_when_done(calibrate_cutting, *options); });
}

void add_roughness(Command& calibrate) {
    auto options = std::make_shared<RoughnessCalibrationOptions>();
    Command command = calibrate.subcommand("roughness", "Tool and material: R_a or R_z from cutting tests");
    command.footer(
        "Data, one cutting test a row: spindle_speed_rpm, feed_mm_rev (per revolution), tool_diameter_mm,\n"
        "axial_depth_mm, force_ratio (F_x/F_z) or feed_force_N and axial_force_N, and the measured Ra_um or Rz_um.\n"
        "At least 7 tests; each variable must change on its own, or be held. Copy the table into tool.toml unchanged.\n"
        "Exit code 1: fewer than 85 of 100 tests lie in the 95 % interval of the model fitted without them, or a "
        "warning "
        "asks\n"
        "for a unit.");
    add_data_and_output(command, *options);
    command.option("--measure", options->measure, "Ra or Rz; default: Ra if the data have it").one_of({"Ra", "Rz"});
    command.option("--hold", options->held, "Column that the shop does not vary: its exponent is not fitted")
        .one_of(std::vector<std::string>(roughness_columns.begin(), roughness_columns.end()));
    command.on_run([options] { return report_when_done(calibrate_roughness, *options); });
}

using ForceShapeCalibration = int (*)(const ForceShapeCalibrationOptions&, std::ostream&);

void add_force_shape(Command& command, ForceShapeCalibration calibration) {
    auto options = std::make_shared<ForceShapeCalibrationOptions>();
    add_data_and_output(command, *options);
    command.option("--cuts", options->cuts, "Which stretch is which cut").required().value_name("CUTS.csv");
    command.option("--machine", options->machine, "Machine parameters").required().value_name("M.toml");
    command.option("--tool", options->tool, "Tool parameters, with the force sensor's low-pass")
        .required()
        .value_name("T.toml");
    command.on_run([options, calibration] { return report_when_done(calibration, *options); });
}

void add_force_drop(Command& calibrate) {
    Command command = calibrate.subcommand("force-drop", "Tool and material: immersion from force drops");
    command.footer(
        "Data: recordings of steady cuts of known width with a force sensor (fx_N, fy_N), or with feed drives where "
        "both\n"
        "axes travel and tooth passing is slow. CUTS.csv says which stretch is which cut: start_s, end_s,\n"
        "tool_diameter_mm, flutes, axial_depth_mm and radial_width_mm. Feeds must differ by a factor of 1.5, widths\n"
        "should span those of the work: at least four different cuts, and no estimate below the narrowest of them.\n"
        "Copy the table into tool.toml unchanged.\n"
        "Exit code 1: the immersion of a cut, estimated by the law fitted to the other cuts, is off by more than 10 "
        "%,\n"
        "or a warning asks for a unit.");
    add_force_shape(command, calibrate_force_drop);
}

void add_tip_angle(Command& calibrate) {
    Command command = calibrate.subcommand("tip-angle",
                                           "Tool in its holder: the angle of its teeth, for depths "
                                           "from the force's shape");
    command.footer(
        "Data: recordings of steady cuts of known depth and width with a force sensor (fx_N, fy_N); one is enough.\n"
        "CUTS.csv as for force-drop. Copy the key into tool.toml's [depth_shape] unchanged.\n"
        "Exit code 1: the cuts disagree by more than four standard deviations, or a warning asks for a unit.");
    add_force_shape(command, calibrate_tip_angle);
}

}  // namespace

void add_calibrate(Command& program) {
    Command calibrate = program.subcommand("calibrate", "Fit parameters to measured data, with standard errors");
    calibrate.requires_subcommand();
    add_friction(calibrate);
    add_spindle(calibrate);
    add_standard_cut(calibrate);
    add_warm_up(calibrate);
    add_cutting(calibrate);
    add_force_drop(calibrate);
    add_tip_angle(calibrate);
    add_roughness(calibrate);
}

void add_estimate(Command& program) {
    auto options = std::make_shared<EstimateOptions>();
    Command command =
        program.subcommand("estimate", "Predict forces from conditions, and depth or width from measured torque");
    command.footer(
        "Conditions: tool_diameter_mm, flutes, spindle_rad_s, feed_mm_s, and axial_depth_mm, radial_width_mm and\n"
        "spindle_torque_Nm if they are known. An empty cell is \"no estimate\".");
    command.option("conditions", options->conditions, "One straight cut a row").required().value_name("CONDITIONS.csv");
    command.option("--tool", options->tool, "Tool with its [cutting] table").required().value_name("T.toml");
    command.output_file("-o,--output", options->output, "The rows with estimates; default: standard output")
        .value_name("OUT.csv");
    add_side(command, options->side, "Side of the cuts; default: that of the tool's file");
    command.on_run([options] { return estimate(*options, std::cout); });
}

}  // namespace millforce::host
