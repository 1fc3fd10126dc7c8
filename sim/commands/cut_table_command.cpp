// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <memory>
#include <random>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "estimation/cutting/cut_geometry.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "loop/scenario.hpp"
#include "parameters/parameter_choices.hpp"

namespace millforce::sim {

namespace {

struct CutTableOptions {
    std::string scenario;
    std::string output;
    double spindle_speed_rpm = 4000.0;
    double noise_share = 0.02;
    std::uint64_t seed = 1;
};

constexpr std::array<double, 4> feed_shares{0.125, 0.25, 0.5, 1.0};             // of the largest feed per tooth
constexpr std::array<double, 6> width_shares{0.08, 0.15, 0.25, 0.4, 0.6, 0.8};  // of the diameter
constexpr std::array<double, 2> depth_shares{0.1, 0.25};                        // of the flute length

struct Cut {
    double feed_per_tooth_mm;
    double radial_width_mm;
    double axial_depth_mm;
};

std::vector<Cut> grid_of(const Scenario& scenario) {
    const double largest_feed_mm = host::decimal(scenario.parameters.tool.control.max_feed_per_tooth_mm);
    std::vector<Cut> cuts;
    for (const double depth : depth_shares) {
        for (const double width : width_shares) {
            for (const double feed : feed_shares) {
                cuts.push_back({feed * largest_feed_mm, width * scenario.cutter.diameter_mm,
                                depth * scenario.cutter.flute_length_mm});
            }
        }
    }
    return cuts;
}

estimation::CutSide side_of(const Scenario& scenario) {
    const auto side = scenario.parameters.tool.side;
    return side == estimation::CutSide::up ? side : estimation::CutSide::down;
}

int cut_table(const CutTableOptions& options) {
    const Scenario believed = read_scenario(options.scenario);
    const Scenario scenario = deviated(believed, believed.deviation, options.seed);
    const CuttingForce force(scenario.cutter, scenario.coefficients, scenario.cutting_options);
    const double spindle_rad_s = options.spindle_speed_rpm * turn / 60.0;
    const auto teeth = static_cast<double>(scenario.cutter.teeth);
    std::mt19937_64 random(options.seed);
    std::normal_distribution<double> noise(0.0, options.noise_share);
    host::AtomicFile file(options.output);
    constexpr std::array<std::string_view, 8> columns{"tool_diameter_mm",  "flutes",          "spindle_rad_s",
                                                      "axial_depth_mm",    "radial_width_mm", "feed_mm_s",
                                                      "spindle_torque_Nm", "normal_force_N"};
    host::CsvWriter csv(file.stream(), columns);
    const std::vector<Cut> cuts = grid_of(scenario);
    for (const Cut& cut : cuts) {
        const auto angles =
            estimation::engagement_angles(side_of(scenario), 2.0 * cut.radial_width_mm / scenario.cutter.diameter_mm);
        const RevolutionLoad load = revolution_load(
            force, cut.feed_per_tooth_mm, uniform_engagement(angles.entry_rad, angles.exit_rad, cut.axial_depth_mm));
        const double feed_mm_s = cut.feed_per_tooth_mm * teeth * spindle_rad_s / turn;
        const double torque_Nm = load.mean_torque_Nm * (1.0 + noise(random));
        const double normal_N = -load.mean_fy_N * (1.0 + noise(random));
        csv.row(std::array{scenario.cutter.diameter_mm, teeth, spindle_rad_s, cut.axial_depth_mm, cut.radial_width_mm,
                           feed_mm_s, torque_Nm, normal_N});
    }
    file.commit();
    fmt::print("{}: {} cuts, {:g} % noise\n", options.output, cuts.size(), 100.0 * options.noise_share);
    return 0;
}

}  // namespace

void add_cut_table(host::Command& program) {
    auto options = std::make_shared<CutTableOptions>();
    host::Command command = program.subcommand(
        "cut-table", "Make a table of straight cuts with the torque and normal force that a dynamometer would measure");
    command.footer(
        "The cuts: feeds per tooth of 1/8, 1/4, 1/2 and 1 of the tool's max_feed_per_tooth_mm, six widths from 8 to\n"
        "80 % of its diameter, depths of 10 and 25 % of its flute length. The table is what 'millforce calibrate\n"
        "cutting' takes.");
    command.option("scenario", options->scenario, "Scenario with tool and material")
        .required()
        .value_name("SCENARIO.toml");
    command.output_file("-o,--output", options->output, "Conditions and measured values")
        .required()
        .value_name("CONDITIONS.csv");
    command.option("--spindle-speed", options->spindle_speed_rpm, "Speed of the spindle in 1/min")
        .within(1.0, 1e5)
        .shows_default();
    command.option("--noise", options->noise_share, "Standard deviation of a measured value, relative")
        .within(0.0, 0.5)
        .shows_default();
    command.option("--seed", options->seed, "Seed of the noise").within(0.0, 4294967295.0).shows_default();
    command.on_run([options] { return cut_table(*options); });
}

}  // namespace millforce::sim
